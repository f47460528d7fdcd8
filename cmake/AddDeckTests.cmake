# thixis_skip_unless_built(<test> <deck> <result>): where the method of the deck is not one of THIXIS_METHODS, adds a test that says so, and
# is skipped.
function(thixis_skip_unless_built test deck result)
  set(${result} FALSE PARENT_SCOPE)
  file(STRINGS ${deck} method REGEX "name=\"name\" type=\"string\" value=")
  string(REGEX REPLACE ".*value=\"([^\"]*)\".*" "\\1" method "${method}")
  if(method AND NOT method IN_LIST THIXIS_METHODS)
    add_test(NAME ${test} COMMAND ${CMAKE_COMMAND} -E echo "not built: ${method}")
    set_tests_properties(${test} PROPERTIES SKIP_REGULAR_EXPRESSION "not built")
    set(${result} TRUE PARENT_SCOPE)
  endif()
endfunction()

# thixis_add_deck_tests(<folder>): every deck below the folder is a test on 1, 2 and 3 ranks. The run judges the deck's `expect` block
# itself and exits 0 if it holds. A new deck is found by the next build. A deck of a method that is not one of THIXIS_METHODS is reported
# as not built.
function(thixis_add_deck_tests folder)
  file(GLOB_RECURSE decks CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.xml)
  set(timeout 120)
  if(THIXIS_SANITIZE)
    set(timeout 1800)
  endif()
  foreach(deck ${decks})
    string(REGEX REPLACE "\\.xml$" "" name ${deck})
    string(REPLACE "/" "." test ${name})
    thixis_skip_unless_built(deck.${test} ${folder}/${deck} skipped)
    if(skipped)
      continue()
    endif()
    foreach(ranks 1 2 3)
      thixis_on_ranks(launcher ${ranks})
      add_test(NAME deck.${test}.${ranks}
        COMMAND ${launcher} $<TARGET_FILE:thixis> run ${folder}/${deck} --output ${CMAKE_CURRENT_BINARY_DIR}/decks/${name}.${ranks})
      set_tests_properties(deck.${test}.${ranks} PROPERTIES ENVIRONMENT "${THIXIS_MPI_ENVIRONMENT}" PROCESSORS ${ranks} TIMEOUT ${timeout})
    endforeach()
  endforeach()
endfunction()
