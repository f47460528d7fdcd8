#pragma once
/// What the sources of this package need of Tpetra.
#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include "thixis/algebra/fwd.hpp"
#include "thixis/core/comm.hpp"

namespace thixis::complementarity {

using Execution = algebra::Vector::execution_space;

inline core::Comm comm_of(const algebra::Map& map) {
  const auto comm = Teuchos::rcp_dynamic_cast<const Teuchos::MpiComm<int>>(map.getComm());
  return core::Comm(comm.is_null() ? MPI_COMM_SELF : (*comm->getRawMpiComm())());
}

/// The values of a vector on this rank, read or overwritten. The view must not outlive the statement or block that uses it.
inline auto read(const algebra::Vector& v) { return Kokkos::subview(v.getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL, 0); }
inline auto write(algebra::Vector& v) { return Kokkos::subview(v.getLocalViewDevice(Tpetra::Access::OverwriteAll), Kokkos::ALL, 0); }
using Read = decltype(read(std::declval<const algebra::Vector&>()));
using Write = decltype(write(std::declval<algebra::Vector&>()));

/// Flags of an active set, kept on the host: Thixis runs on host spaces only (fwd.hpp of algebra).
using Flags = Kokkos::View<const std::uint8_t*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
using FlagsOut = Kokkos::View<std::uint8_t*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

}  // namespace thixis::complementarity
