#pragma once
/// Tpetra vectors and active sets as the Views that the kernels of this package read and write.
#include <cstdint>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::complementarity {

using algebra::comm_of;
using Execution = algebra::Vector::execution_space;

/// The values of a vector on this rank, read or overwritten. The view must be gone before the vector is used in another way.
inline auto read(const algebra::Vector& v) { return Kokkos::subview(v.getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL(), 0); }
inline auto write(algebra::Vector& v) { return Kokkos::subview(v.getLocalViewDevice(Tpetra::Access::OverwriteAll), Kokkos::ALL(), 0); }
using Read = decltype(read(std::declval<const algebra::Vector&>()));
using Write = decltype(write(std::declval<algebra::Vector&>()));

/// Flags of an active set, kept on the host: Thixis runs on host spaces only (fwd.hpp of algebra).
using Flags = Kokkos::View<const std::uint8_t*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
using FlagsOut = Kokkos::View<std::uint8_t*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

}  // namespace thixis::complementarity
