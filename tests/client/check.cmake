# Script: installs the build tree BUILD into an empty folder and builds and runs this client on it, all below FOLDER.
cmake_policy(SET CMP0054 NEW)
file(REMOVE_RECURSE ${FOLDER})

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    string(JOIN " " command ${ARGV})
    message(FATAL_ERROR "${command}\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/prefix)
file(GLOB_RECURSE package ${FOLDER}/prefix/*.cmake)
foreach(file ${package})
  file(STRINGS ${file} lines)
  foreach(folder ${BUILD} ${SOURCE} ${FOLDER})
    if("${lines}" MATCHES "${folder}")
      message(FATAL_ERROR "${file} names a folder of the build: ${folder}")
    endif()
  endforeach()
endforeach()

# Moved: an installed package stands where it is put.
file(RENAME ${FOLDER}/prefix ${FOLDER}/moved)
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${CMAKE_CURRENT_LIST_DIR} -B ${FOLDER}/build -DCMAKE_PREFIX_PATH=${FOLDER}/moved
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${FOLDER}/build)
run(${CMAKE_CTEST_COMMAND} --test-dir ${FOLDER}/build --output-on-failure)
