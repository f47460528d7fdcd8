# Everything that Thixis is built on, as targets:
#   thixis::mpi        MPI without its C++ bindings
#   thixis::kokkos     Kokkos alone          thixis::tpetra   Tpetra (and Kokkos, Teuchos)
#   thixis::solvers    Belos, Ifpack2, Amesos2, MueLu         thixis::nox      NOX
#   thixis::hdf5       parallel HDF5         thixis::metis, thixis::muparser, thixis::zlib
# Installed along with the libraries: a client of Thixis finds the same things by the same file. Hence the targets are imported ones,
# which an export refers to by name.
include_guard(DIRECTORY)

find_package(MPI REQUIRED COMPONENTS C CXX)
add_library(thixis::mpi INTERFACE IMPORTED)
target_link_libraries(thixis::mpi INTERFACE MPI::MPI_CXX)
target_compile_definitions(thixis::mpi INTERFACE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)

foreach(package Kokkos Tpetra Belos Ifpack2 Amesos2 MueLu NOX)
  find_package(${package} REQUIRED)
endforeach()

# One interface target for some Trilinos packages; Trilinos 13 exports plain targets without include folders, 14 and later `<p>::all_libs`.
function(thixis_trilinos_target name)
  add_library(thixis::${name} INTERFACE IMPORTED)
  foreach(package ${ARGN})
    if(TARGET ${package}::all_libs)
      target_link_libraries(thixis::${name} INTERFACE ${package}::all_libs)
    else()
      set(folders)
      foreach(folder ${${package}_INCLUDE_DIRS} ${${package}_TPL_INCLUDE_DIRS})
        get_filename_component(folder ${folder} REALPATH)
        list(APPEND folders ${folder})
      endforeach()
      list(REMOVE_DUPLICATES folders)
      list(REMOVE_ITEM folders /usr/include)
      target_include_directories(thixis::${name} SYSTEM INTERFACE ${folders})
      target_link_libraries(thixis::${name} INTERFACE ${${package}_LIBRARIES})
    endif()
  endforeach()
  target_link_libraries(thixis::${name} INTERFACE thixis::mpi)
endfunction()
thixis_trilinos_target(kokkos Kokkos)
thixis_trilinos_target(tpetra Tpetra)
thixis_trilinos_target(solvers Belos Ifpack2 Amesos2 MueLu)
thixis_trilinos_target(nox NOX)

set(HDF5_PREFER_PARALLEL TRUE)
find_package(HDF5 REQUIRED COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "Thixis needs the parallel HDF5 (Debian: libhdf5-openmpi-dev); the one found is serial.")
endif()
add_library(thixis::hdf5 INTERFACE IMPORTED)
target_link_libraries(thixis::hdf5 INTERFACE ${HDF5_C_LIBRARIES} thixis::mpi)
target_include_directories(thixis::hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})

# A library without CMake files of its own.
function(thixis_plain_target name header library)
  find_path(THIXIS_${name}_INCLUDE ${header} REQUIRED)
  find_library(THIXIS_${name}_LIBRARY ${library} REQUIRED)
  add_library(thixis::${name} INTERFACE IMPORTED)
  target_include_directories(thixis::${name} SYSTEM INTERFACE ${THIXIS_${name}_INCLUDE})
  target_link_libraries(thixis::${name} INTERFACE ${THIXIS_${name}_LIBRARY})
endfunction()
thixis_plain_target(metis metis.h metis)
thixis_plain_target(muparser muParser.h muparser)
thixis_plain_target(zlib zlib.h z)
find_package(Basix REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(fmt REQUIRED)
find_package(pugixml REQUIRED)
