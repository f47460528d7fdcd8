#pragma once
#include <Kokkos_Core.hpp>

namespace thixis::bound {

/// A copy on the host.
template <class V>
auto on_host(const V& v) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), v);
}

}  // namespace thixis::bound
