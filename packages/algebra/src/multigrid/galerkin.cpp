#include "multigrid/galerkin.hpp"

#include <Tpetra_RowMatrixTransposer.hpp>
#include <algorithm>

#include "thixis/core/assert.hpp"

namespace thixis::algebra {
namespace {

using Range = Kokkos::RangePolicy<Node::execution_space>;
using Local = Matrix::local_matrix_device_type;
using Export = Tpetra::Export<LocalIndex, GlobalIndex, Node>;

/// A matrix of rows that may lie on several ranks, of a map from vectors on `coarse` to such vectors.
MatrixPtr make_overlapping(const MapPtr& rows, const MapPtr& columns, const MapPtr& coarse, const RowMap& row_map, const Entries& entries,
                           const Values& values) {
  const auto A = Teuchos::rcp(new Matrix(rows, columns, row_map, entries, values));
  A->fillComplete(coarse, coarse);
  return A;
}

/// P at all columns of A, whose rows are those of P.
Teuchos::RCP<const Matrix> at_columns(const Teuchos::RCP<const Matrix>& P, const Matrix& A) {
  const auto import = A.getGraph()->getImporter();
  if (import.is_null()) return P;
  return Tpetra::importAndFillCompleteCrsMatrix<Matrix>(P, *import, P->getDomainMap(), A.getColMap());
}

/// The columns of each row of Pᵀ A P, sorted. On the host: once per mesh.
void find_pattern(const Local& A, const Local& P, const Local& transpose, RowMap& row_map, Entries& entries) {
  const auto host = Kokkos::HostSpace();
  const auto of_A = Kokkos::create_mirror_view_and_copy(host, A.graph.row_map),
             of_P = Kokkos::create_mirror_view_and_copy(host, P.graph.row_map),
             of_T = Kokkos::create_mirror_view_and_copy(host, transpose.graph.row_map);
  const auto in_A = Kokkos::create_mirror_view_and_copy(host, A.graph.entries),
             in_P = Kokkos::create_mirror_view_and_copy(host, P.graph.entries),
             in_T = Kokkos::create_mirror_view_and_copy(host, transpose.graph.entries);
  std::vector<LocalIndex> column, seen(P.numCols(), -1);
  std::vector<std::size_t> begin(1, 0);
  for (LocalIndex p = 0; p < transpose.numRows(); ++p) {
    for (auto t = of_T(p); t < of_T(p + 1); ++t)
      for (auto e = of_A(in_T(t)); e < of_A(in_T(t) + 1); ++e)
        for (auto k = of_P(in_A(e)); k < of_P(in_A(e) + 1); ++k)
          if (std::exchange(seen[in_P(k)], p) != p) column.push_back(in_P(k));
    std::sort(column.begin() + static_cast<std::ptrdiff_t>(begin.back()), column.end());
    begin.push_back(column.size());
  }
  row_map = RowMap("thixis::algebra::row_map", begin.size());
  entries = Entries("thixis::algebra::entries", column.size());
  Kokkos::deep_copy(row_map, Kokkos::View<const std::size_t*, Kokkos::HostSpace>(begin.data(), begin.size()));
  Kokkos::deep_copy(entries, Kokkos::View<const LocalIndex*, Kokkos::HostSpace>(column.data(), column.size()));
}

template <class Coupled>
struct Multiply {
  Local A, P, transpose;
  Coupled coupled;
  RowMap row_map;
  Entries entries;
  Values values;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex p) const {
    const std::size_t begin = row_map(p), end = row_map(p + 1);
    for (std::size_t k = begin; k < end; ++k) values(k) = 0;
    for (auto t = transpose.graph.row_map(p); t < transpose.graph.row_map(p + 1); ++t) {
      const LocalIndex r = transpose.graph.entries(t);
      if (coupled(r, 0) != 0) add_row(begin, r, transpose.values(t));
    }
  }
  KOKKOS_FUNCTION void add_row(std::size_t begin, LocalIndex r, double weight) const {
    for (auto e = A.graph.row_map(r); e < A.graph.row_map(r + 1); ++e) {
      const LocalIndex s = A.graph.entries(e);
      if (coupled(s, 0) == 0) continue;
      const double a = weight * A.values(e);
      for (auto k = P.graph.row_map(s); k < P.graph.row_map(s + 1); ++k) {
        std::size_t at = begin;
        while (entries(at) != P.graph.entries(k)) ++at;
        values(at) += a * P.values(k);
      }
    }
  }
};

struct Place {
  Values from;
  Kokkos::View<const std::size_t*> place;
  Values to;

  KOKKOS_FUNCTION void operator()(std::size_t k) const { to(place(k)) = from(k); }
};

/// 1 on a diagonal where nothing is.
struct FillGaps {
  Local A;  ///< updated

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    for (auto k = A.graph.row_map(i); k < A.graph.row_map(i + 1); ++k)
      if (A.graph.entries(k) == i && A.values(k) == 0) A.values(k) = 1;
  }
};

/// Where the first entries of `of` are in `in`, whose rows of this rank come first in `of`.
Kokkos::View<const std::size_t*> places(const Matrix& of, const Matrix& in) {
  const auto host = Kokkos::HostSpace();
  const auto from = of.getLocalMatrixDevice().graph, to = in.getLocalMatrixDevice().graph;
  const auto from_begin = Kokkos::create_mirror_view_and_copy(host, from.row_map),
             to_begin = Kokkos::create_mirror_view_and_copy(host, to.row_map);
  const auto from_column = Kokkos::create_mirror_view_and_copy(host, from.entries),
             to_column = Kokkos::create_mirror_view_and_copy(host, to.entries);
  const LocalIndex rows = local_rows(in);
  const Kokkos::View<std::size_t*> place("thixis::algebra::place_in_product", from_begin(rows));
  const auto out = Kokkos::create_mirror_view(place);
  for (LocalIndex i = 0; i < rows; ++i)
    for (auto k = from_begin(i); k < from_begin(i + 1); ++k) {
      const LocalIndex column = in.getColMap()->getLocalElement(of.getColMap()->getGlobalElement(from_column(k)));
      for (out(k) = to_begin(i); to_column(out(k)) != column; ++out(k)) THIXIS_ASSERT(out(k) + 1 < to_begin(i + 1), "the column is there");
    }
  Kokkos::deep_copy(place, out);
  return place;
}

}  // namespace

Interpolation::Interpolation(const Teuchos::RCP<const Matrix>& P) : P_(P) {
  Tpetra::RowMatrixTransposer<double, LocalIndex, GlobalIndex, Node> transposer(P);
  transpose_ = transposer.createTransposeLocal();
}

Galerkin::Galerkin(const Teuchos::RCP<const Matrix>& A, const Interpolation& interpolation)
    : interpolation_(interpolation), P_(at_columns(Teuchos::rcpFromRef(interpolation.P()), *A)) {
  const Matrix& transpose = interpolation.transpose();
  const MapPtr coarse = interpolation.P().getDomainMap(), rows = transpose.getRowMap();
  find_pattern(A->getLocalMatrixDevice(), P_->getLocalMatrixDevice(), transpose.getLocalMatrixDevice(), row_map_, entries_);
  values_ = Values("thixis::algebra::product", entries_.extent(0));
  coupled_ = Teuchos::rcp(new Vector(A->getColMap()));
  const auto here = make_overlapping(rows, P_->getColMap(), coarse, row_map_, entries_, values_);
  if (coarse->getComm()->getSize() == 1) {
    product_ = here;
    return;
  }
  const Export to_owners(rows, coarse);
  const auto sum =
      Tpetra::exportAndFillCompleteCrsMatrix<Matrix>(Teuchos::rcp_implicit_cast<const Matrix>(here), to_owners, coarse, coarse);
  product_ = Teuchos::rcp(new Matrix(sum->getCrsGraph()));
  product_->fillComplete(coarse, coarse);
  place_ = places(*here, *product_);
  take_from_other_ranks();
}

/// The rows of the product that belong to other ranks, as a matrix of their own.
void Galerkin::take_from_other_ranks() {
  const Map& rows = *interpolation_.transpose().getRowMap();
  const LocalIndex own = local_size(*product_->getRowMap()), all = local_size(rows);
  std::vector<GlobalIndex> ids;
  for (LocalIndex p = own; p < all; ++p) ids.push_back(rows.getGlobalElement(p));
  const MapPtr others = map_of(ids, comm_of(rows));
  const std::size_t first = place_.extent(0), last = entries_.extent(0);
  const RowMap row_map("thixis::algebra::row_map", all - own + 1);
  const auto begin = row_map_;
  Kokkos::parallel_for(
      "thixis::algebra::rows_sent", Range(0, row_map.extent_int(0)), KOKKOS_LAMBDA(int p) { row_map(p) = begin(own + p) - first; });
  sent_ = make_overlapping(others, P_->getColMap(), product_->getDomainMap(), row_map, Kokkos::subview(entries_, std::pair(first, last)),
                           Kokkos::subview(values_, std::pair(first, last)));
  send_ = Teuchos::rcp(new Export(others, product_->getRowMap()));
}

void Galerkin::set_matrix(const Matrix& A, const Vector& coupled) {
  const auto import = A.getGraph()->getImporter();
  if (import.is_null()) coupled_->assign(coupled);
  else coupled_->doImport(coupled, *import, Tpetra::INSERT);
  {
    const auto mask = std::as_const(*coupled_).getLocalViewDevice(Tpetra::Access::ReadOnly);
    Multiply<std::decay_t<decltype(mask)>> kernel{A.getLocalMatrixDevice(), P_->getLocalMatrixDevice(),
                                                  interpolation_.transpose().getLocalMatrixDevice(), mask};
    kernel.row_map = row_map_;
    kernel.entries = entries_;
    kernel.values = values_;
    Kokkos::parallel_for("thixis::algebra::galerkin", Range(0, kernel.transpose.numRows()), kernel);
  }
  if (!sent_.is_null()) {
    product_->resumeFill();
    product_->setAllToScalar(0);
    Kokkos::parallel_for("thixis::algebra::own_products", Range(0, place_.extent(0)),
                         Place{values_, place_, product_->getLocalMatrixDevice().values});
    product_->doExport(*sent_, *send_, Tpetra::ADD);
    product_->fillComplete(product_->getDomainMap(), product_->getRangeMap());
  }
  const Local local = product_->getLocalMatrixDevice();
  Kokkos::parallel_for("thixis::algebra::fill_gaps", Range(0, local.numRows()), FillGaps{local});
}

}  // namespace thixis::algebra
