/// Maps, graphs and matrices of systems with several unknowns per node, and of parts of them.
#include "thixis/algebra/structure.hpp"

namespace thixis::algebra {
namespace {

using Local = Matrix::local_matrix_device_type;
using Range = Kokkos::RangePolicy<Node::execution_space>;

/// Row fields·i + f: the entries of row i, in the columns fields·j + f.
struct Interlace {
  Local A;
  int fields;
  RowMap row_map;  ///< out, overwritten, as the others
  Entries entries;
  Values values;

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    const std::size_t begin = A.graph.row_map(i), length = A.graph.row_map(i + 1) - begin;
    for (int f = 0; f < fields; ++f) {
      const std::size_t to = fields * begin + f * length;
      row_map(fields * i + f) = to;
      for (std::size_t k = 0; k < length; ++k) {
        entries(to + k) = fields * A.graph.entries(begin + k) + f;
        values(to + k) = A.values(begin + k);
      }
    }
    if (i + 1 == A.numRows()) row_map(fields * A.numRows()) = fields * A.nnz();
  }
};

struct CountSelected {
  Local A;
  Kokkos::View<const LocalIndex*> selected;
  RowMap row_map;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex i, std::size_t& sum, bool last) const {
    if (last) row_map(i) = sum;
    if (i < selected.extent_int(0)) sum += A.graph.row_map(selected(i) + 1) - A.graph.row_map(selected(i));
  }
};

struct CopySelected {
  Local A;
  Kokkos::View<const LocalIndex*> selected;
  RowMap row_map;
  Entries entries;  ///< out, overwritten, as the values
  Values values;

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    std::size_t from = A.graph.row_map(selected(i));
    for (std::size_t to = row_map(i); to < row_map(i + 1); ++to, ++from) {
      entries(to) = A.graph.entries(from);
      values(to) = A.values(from);
    }
  }
};

}  // namespace

MapPtr interlaced(const MapPtr& map, int fields) {
  if (fields == 1) return map;
  const LocalIndex count = local_size(*map);
  if (map->isContiguous())
    return Teuchos::rcp(
        new Map(fields * map->getGlobalNumElements(), static_cast<std::size_t>(fields) * count, map->getIndexBase(), map->getComm()));
  Teuchos::Array<GlobalIndex> ids(static_cast<std::size_t>(fields) * count);
  for (LocalIndex l = 0; l < count; ++l)
    for (int f = 0; f < fields; ++f) ids[fields * l + f] = fields * map->getGlobalElement(l) + f;
  return Teuchos::rcp(new Map(fields * map->getGlobalNumElements(), ids(), map->getIndexBase(), map->getComm()));
}

GraphPtr make_graph(const MapPtr& rows, const MapPtr& columns, const RowMap& row_map, const Entries& entries) {
  const auto graph = Teuchos::rcp(new Graph(rows, columns, row_map, entries));
  graph->fillComplete(rows, rows);
  return graph;
}

MatrixPtr make_matrix(const MapPtr& rows, const MapPtr& columns, const MapPtr& domain, const RowMap& row_map, const Entries& entries,
                      const Values& values) {
  const auto A = Teuchos::rcp(new Matrix(rows, columns, row_map, entries, values));
  A->fillComplete(domain, rows);
  return A;
}

Teuchos::RCP<const Matrix> interlaced(const Teuchos::RCP<const Matrix>& A, int fields) {
  if (fields == 1) return A;
  const Local local = A->getLocalMatrixDevice();
  const RowMap row_map("thixis::algebra::row_map", static_cast<std::size_t>(fields) * local.numRows() + 1);
  const Entries entries("thixis::algebra::entries", fields * local.nnz());
  const Values values("thixis::algebra::values", fields * local.nnz());
  Kokkos::parallel_for("thixis::algebra::interlace", Range(0, local.numRows()), Interlace{local, fields, row_map, entries, values});
  return make_matrix(interlaced(A->getRowMap(), fields), interlaced(A->getColMap(), fields), interlaced(A->getDomainMap(), fields), row_map,
                     entries, values);
}

MatrixPtr select_rows(const Matrix& A, const MapPtr& rows, const Kokkos::View<const LocalIndex*>& selected) {
  const Local local = A.getLocalMatrixDevice();
  const RowMap row_map("thixis::algebra::row_map", selected.extent(0) + 1);
  std::size_t count = 0;
  Kokkos::parallel_scan("thixis::algebra::count_selected", Range(0, row_map.extent(0)), CountSelected{local, selected, row_map}, count);
  const Entries entries("thixis::algebra::entries", count);
  const Values values("thixis::algebra::values", count);
  Kokkos::parallel_for("thixis::algebra::copy_selected", Range(0, selected.extent(0)),
                       CopySelected{local, selected, row_map, entries, values});
  return make_matrix(rows, A.getColMap(), A.getDomainMap(), row_map, entries, values);
}

}  // namespace thixis::algebra
