# thixis_add_deck_tests(<folder>): every deck below the folder is a test on 1, 2 and 3 ranks. The run judges the deck's `expect` block
# itself and exits 0 if it holds. A new deck is found by the next build.
function(thixis_add_deck_tests folder)
  file(GLOB_RECURSE decks CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.xml)
  set(timeout 120)
  if(THIXIS_SANITIZE)
    set(timeout 1800)
  endif()
  foreach(deck ${decks})
    string(REGEX REPLACE "\\.xml$" "" name ${deck})
    string(REPLACE "/" "." test ${name})
    foreach(ranks 1 2 3)
      thixis_on_ranks(launcher ${ranks})
      add_test(NAME deck.${test}.${ranks}
        COMMAND ${launcher} $<TARGET_FILE:thixis> run ${folder}/${deck} --output ${CMAKE_CURRENT_BINARY_DIR}/decks/${name}.${ranks})
      set_tests_properties(deck.${test}.${ranks} PROPERTIES ENVIRONMENT "${THIXIS_MPI_ENVIRONMENT}" PROCESSORS ${ranks} TIMEOUT ${timeout})
    endforeach()
  endforeach()
endfunction()
