# ccache, where present, makes a rebuild after a branch change or in a fresh clone cheap.
find_program(THIXIS_CCACHE ccache)
if(THIXIS_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${THIXIS_CCACHE})
endif()
