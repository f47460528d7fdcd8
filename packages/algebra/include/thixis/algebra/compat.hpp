#pragma once
/// Trilinos 13.2 to 17 for one source: the only file that asks for the version, or knows a name that has changed.
#include <Trilinos_version.h>

#include <Kokkos_Macros.hpp>
#include <cstddef>

namespace Kokkos {
class Serial;
class OpenMP;
class HostSpace;
#if TRILINOS_MAJOR_MINOR_VERSION < 140000
namespace Compat {
template <class ExecutionSpace, class MemorySpace>
class KokkosDeviceWrapperNode;
}
#endif
}  // namespace Kokkos
#if TRILINOS_MAJOR_MINOR_VERSION >= 140000
namespace Tpetra::KokkosCompat {
template <class ExecutionSpace, class MemorySpace>
class KokkosDeviceWrapperNode;
}
#endif

namespace thixis::algebra::compat {

constexpr const char* trilinos_version = TRILINOS_VERSION_STRING;
constexpr int kokkos_version = KOKKOS_VERSION;  ///< 10000 major + 100 minor + patch

#if TRILINOS_MAJOR_MINOR_VERSION < 140000
using Kokkos::Compat::KokkosDeviceWrapperNode;
#else
using Tpetra::KokkosCompat::KokkosDeviceWrapperNode;
#endif

/// Ids of a Tpetra::Map on this rank.
template <class Map>
std::size_t local_size(const Map& map) {
#if TRILINOS_MAJOR_MINOR_VERSION < 130400
  return map.getNodeNumElements();
#else
  return map.getLocalNumElements();
#endif
}

}  // namespace thixis::algebra::compat
