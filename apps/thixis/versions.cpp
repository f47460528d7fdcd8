#include "versions.hpp"

#include <hdf5.h>
#include <mpi.h>

#include <Kokkos_Core.hpp>

#include "thixis/algebra/compat.hpp"

namespace thixis {
namespace {

std::string dotted(int a, int b, int c) { return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c); }

std::string mpi_library() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string all(text, length);
  return all.substr(0, all.find_first_of(",\n"));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> versions() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  constexpr int kokkos = algebra::compat::kokkos_version;
  return {{"thixis", version_number},
          {"git", version_git},
          {"trilinos", algebra::compat::trilinos_version},
          {"kokkos", dotted(kokkos / 10000, kokkos / 100 % 100, kokkos % 100)},
          {"kokkos backend", Kokkos::DefaultExecutionSpace::name()},
          {"mpi", mpi_library()},
          {"hdf5", dotted(major, minor, release)},
          {"compiler", __VERSION__}};
}

}  // namespace thixis
