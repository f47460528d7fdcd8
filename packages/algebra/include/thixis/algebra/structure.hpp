#pragma once
/// Matrices made of local rows, of several unknowns per node, and of parts of others.
#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

using RowMap = Graph::local_graph_device_type::row_map_type::non_const_type;
using Entries = Graph::local_graph_device_type::entries_type::non_const_type;
using Values = Matrix::local_matrix_device_type::values_type::non_const_type;

/// Collective. The matrix of a map from vectors on `domain`, given in local column indices, sorted in each row. `columns`: those of
/// `domain` on this rank first, in its order.
MatrixPtr make_matrix(const MapPtr& rows, const MapPtr& columns, const MapPtr& domain, const RowMap& row_map, const Entries& entries,
                      const Values& values);
/// Collective. The same matrix for each of `fields` unknowns per id of its maps.
Teuchos::RCP<const Matrix> interlaced(const Teuchos::RCP<const Matrix>& A, int fields);
/// Collective. Row i of the result, on `rows`, is row selected(i) of A on this rank.
MatrixPtr select_rows(const Matrix& A, const MapPtr& rows, const Kokkos::View<const LocalIndex*>& selected);

}  // namespace thixis::algebra
