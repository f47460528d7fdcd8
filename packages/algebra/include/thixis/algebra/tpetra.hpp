#pragma once
/// The one header that brings in Tpetra.
#include <Kokkos_Core.hpp>
#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_CrsGraph.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include "thixis/algebra/fwd.hpp"
#include "thixis/core/comm.hpp"

namespace thixis::algebra {

// --- Sizes on this rank, not collective ------------------------------------------------------------------------------------------

inline LocalIndex local_size(const Map& map) { return static_cast<LocalIndex>(compat::local_size(map)); }
inline LocalIndex local_rows(const Graph& graph) { return local_size(*graph.getRowMap()); }
inline LocalIndex local_rows(const Matrix& A) { return local_size(*A.getRowMap()); }
inline LocalIndex local_columns(const Graph& graph) { return local_size(*graph.getColMap()); }  ///< ghosts included
inline LocalIndex local_columns(const Matrix& A) { return local_size(*A.getColMap()); }
inline std::size_t local_entries(const Matrix& A) { return A.getLocalMatrixDevice().nnz(); }

// --- Communicators and maps ------------------------------------------------------------------------------------------------------

inline Teuchos::RCP<const Teuchos::Comm<int>> teuchos_comm(const core::Comm& comm) {
  return Teuchos::rcp(new Teuchos::MpiComm<int>(comm.mpi()));
}
/// The ranks among which a map, vector or matrix is distributed (itself alone for a serial communicator).
inline core::Comm comm_of(const Map& map) {
  const auto* mpi = dynamic_cast<const Teuchos::MpiComm<int>*>(map.getComm().get());
  return core::Comm(mpi ? (*mpi->getRawMpiComm())() : MPI_COMM_SELF);
}

/// Collective. The map that gives `count` ids to this rank: 0, 1, 2, ... in the order of the ranks. A count may be 0, on all ranks, too.
inline MapPtr contiguous_map(LocalIndex count, const core::Comm& comm) {
  const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  return Teuchos::rcp(new Map(unknown, static_cast<std::size_t>(count), 0, teuchos_comm(comm)));
}
/// Collective. The map of these ids on this rank, in this order.
inline MapPtr map_of(const std::vector<GlobalIndex>& ids, const core::Comm& comm) {
  const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  return Teuchos::rcp(new Map(unknown, Teuchos::ArrayView<const GlobalIndex>(ids.data(), ids.size()), 0, teuchos_comm(comm)));
}

/// The map of `fields` unknowns per id of another map: id g becomes fields·g, ..., fields·g + fields - 1. Not collective for column maps.
MapPtr interlaced(const MapPtr& map, int fields);

/// Collective. The graph with these rows and columns, given in local column indices, sorted in each row.
GraphPtr make_graph(const MapPtr& rows, const MapPtr& columns, const Graph::local_graph_device_type::row_map_type::non_const_type& row_map,
                    const Graph::local_graph_device_type::entries_type::non_const_type& entries);

// --- The local part of a vector as a one-dimensional View on the host ------------------------------------------------------------
// A view must be gone before the vector is used in another way.

inline auto host_view(const Vector& x) { return Kokkos::subview(x.getLocalViewHost(Tpetra::Access::ReadOnly), Kokkos::ALL(), 0); }
inline auto host_view(Vector& x) { return Kokkos::subview(x.getLocalViewHost(Tpetra::Access::ReadWrite), Kokkos::ALL(), 0); }
/// For a vector whose old values do not matter.
inline auto host_overwrite(Vector& x) { return Kokkos::subview(x.getLocalViewHost(Tpetra::Access::OverwriteAll), Kokkos::ALL(), 0); }

// --- Collective figures ----------------------------------------------------------------------------------------------------------

/// Euclidean norm over all ranks.
inline double norm2(const Vector& x) { return x.norm2(); }
/// r <- b - A x; returns |r|.
inline double residual(const Operator& A, const Vector& b, const Vector& x, Vector& r) {
  A.apply(x, r);
  r.update(1., b, -1.);
  return r.norm2();
}

}  // namespace thixis::algebra
