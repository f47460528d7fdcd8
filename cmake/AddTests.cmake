# thixis_add_unit_tests(<package> SOURCES <files> [RANKS <n>...] [LIBRARIES <targets>])
#
# One executable test_<package> with GoogleTest, run as a whole on each of the rank counts (default: 1). Sources see the private
# headers of the package, too.
find_package(GTest)
if(NOT GTest_FOUND)
  message(FATAL_ERROR "The tests need GoogleTest (Debian: libgtest-dev); to build without them, set THIXIS_TESTS to OFF.")
endif()
set(THIXIS_MPI_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
  OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1 ASAN_OPTIONS=detect_leaks=0)

add_custom_target(unit_tests)

# The command line that runs a program on some ranks.
function(thixis_on_ranks result ranks)
  if(ranks EQUAL 1)
    set(${result} "" PARENT_SCOPE)
  else()
    set(${result} ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} ${MPIEXEC_PREFLAGS} PARENT_SCOPE)
  endif()
endfunction()

function(thixis_add_unit_tests package)
  cmake_parse_arguments(TEST "" "" "SOURCES;RANKS;LIBRARIES" ${ARGN})
  if(NOT TEST_RANKS)
    set(TEST_RANKS 1)
  endif()
  add_executable(test_${package} ${TEST_SOURCES} ${PROJECT_SOURCE_DIR}/tests/unit/main.cpp)
  target_include_directories(test_${package} PRIVATE ${PROJECT_SOURCE_DIR}/packages/${package}/src ${PROJECT_SOURCE_DIR}/tests/unit)
  target_link_libraries(test_${package} PRIVATE thixis::${package} thixis::tpetra ${TEST_LIBRARIES} GTest::gtest thixis_warnings)
  target_compile_definitions(test_${package} PRIVATE THIXIS_SCRATCH="${CMAKE_CURRENT_BINARY_DIR}")
  add_dependencies(unit_tests test_${package})
  set(timeout 300)
  if(THIXIS_SANITIZE)
    set(timeout 1800)
  endif()
  foreach(ranks ${TEST_RANKS})
    thixis_on_ranks(launcher ${ranks})
    add_test(NAME unit.${package}.${ranks} COMMAND ${launcher} $<TARGET_FILE:test_${package}>)
    set_tests_properties(unit.${package}.${ranks} PROPERTIES ENVIRONMENT "${THIXIS_MPI_ENVIRONMENT}" PROCESSORS ${ranks} TIMEOUT ${timeout})
  endforeach()
endfunction()
