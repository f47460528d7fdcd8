#include "condensed_solver.hpp"

#include "thixis/method/condensation.hpp"

namespace thixis::models {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using method::ElementUnknowns;
using Matrices = Kokkos::View<double***, Kokkos::LayoutRight>;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// (element, fields i + f): unknown i, field f.
ElementUnknowns interlaced(const ElementUnknowns& elements, int fields) {
  if (fields == 1) return elements;
  const Kokkos::View<LocalIndex**, Kokkos::LayoutRight> all("thixis::models::element_fields", elements.extent(0),
                                                            fields * elements.extent(1));
  Kokkos::parallel_for(
      "thixis::models::element_fields", Range(0, elements.extent_int(0)), KOKKOS_LAMBDA(int e) {
        for (int i = 0; i < elements.extent_int(1); ++i)
          for (int f = 0; f < fields; ++f) all(e, fields * i + f) = elements(e, i) < 0 ? -1 : fields * elements(e, i) + f;
      });
  return all;
}

/// 1 / the number of elements that share each unknown, for the rows of this rank; 1 for interior ghosts.
Kokkos::View<double*> share_of_elements(const ElementUnknowns& elements, LocalIndex columns) {
  const Kokkos::View<double*> share("thixis::models::share", columns);
  const auto host = Kokkos::create_mirror_view(share);
  const auto unknowns = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), elements);
  for (std::size_t e = 0; e < unknowns.extent(0); ++e)
    for (std::size_t i = 0; i < unknowns.extent(1); ++i)
      if (unknowns(e, i) >= 0) host(unknowns(e, i)) += 1;
  for (LocalIndex column = 0; column < columns; ++column) host(column) = host(column) > 0 ? 1 / host(column) : 0;
  Kokkos::deep_copy(share, host);
  return share;
}

/// The matrix of a cell, contact points cleared in it: summed over the cells, it is the cleared matrix. The penalty of a point is spread
/// over its cells.
template <class V>
struct Constrain {
  Matrices S[2];  ///< of unit factors
  Blocks B;
  ElementUnknowns elements;
  LocalIndex first;
  V contact, penalty;  ///< at columns
  Kokkos::View<const double*> share;
  Matrices A;  ///< out, overwritten

  KOKKOS_FUNCTION bool known(LocalIndex unknown) const { return unknown >= 0 && contact(unknown, 0) > 0; }
  KOKKOS_FUNCTION void operator()(int e) const {
    const int n = elements.extent_int(1), last = B.fields - 1;
    for (int i = 0; i < n; ++i)
      for (int f = 0; f < B.fields; ++f) {
        const LocalIndex row = elements(first + e, i);
        const bool row_known = f == last && known(row);
        for (int j = 0; j < n; ++j)
          for (int g = 0; g < B.fields; ++g) {
            double value = B.c[f][g][0] * S[0](e, i, j) + B.c[f][g][1] * S[1](e, i, j);
            if (i == j && f == g) {
              if (f == last && row >= 0) value += share(row) * penalty(row, 0);
            } else if (row_known || (g == last && known(elements(first + e, j)))) {
              value = 0;
            }
            A(e, B.fields * i + f, B.fields * j + g) = value;
          }
      }
  }
};

class CondensedSolver final : public ConstrainedSolver {
 public:
  CondensedSolver(const MembraneOperator& membranes, const Blocks& blocks, const algebra::LinearParams& params,
                  const Teuchos::RCP<const MultiVector>& coordinates)
      : membranes_(membranes),
        forms_(*membranes.condensed),
        blocks_(blocks),
        condensation_(algebra::interlaced(membranes.map(), blocks.fields),
                      algebra::interlaced(membranes.matrix[0]->getColMap(), blocks.fields), interlaced(forms_.elements, blocks.fields),
                      blocks.fields * forms_.interior,
                      forms_.symmetric ? method::LocalForm::positive_definite : method::LocalForm::general),
        solver_(params),
        coordinates_(coordinates_left(*coordinates)),
        share_(share_of_elements(forms_.elements, algebra::local_columns(*membranes.matrix[0]))) {}

  void set_matrix(const Vector& contact, const Vector& penalty) override {
    const Vector contact_columns = at_columns(membranes_, contact), penalty_columns = at_columns(membranes_, penalty);
    const auto known = contact_columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto added = penalty_columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
    condensation_.set_matrix([&](LocalIndex first, const Matrices& A) {
      const bool one = membranes_.shared();
      reserve(A.extent_int(0));
      Matrices S[2];
      for (int alpha = 0; alpha < (one ? 1 : 2); ++alpha) {
        S[alpha] = Kokkos::subview(cells_[alpha], std::pair(0, A.extent_int(0)), Kokkos::ALL, Kokkos::ALL);
        forms_.form[alpha]->matrices(first, S[alpha]);
      }
      if (one) S[1] = S[0];
      Kokkos::parallel_for(
          "thixis::models::constrain", Range(0, A.extent_int(0)),
          Constrain<std::decay_t<decltype(known)>>{{S[0], S[1]}, blocks_, forms_.elements, first, known, added, share_, A});
    });
    solver_.set_matrix(condensation_.matrix(), blocks_.fields, coordinates_);
  }

  void set_matrix() override {
    const Vector none(membranes_.map());
    set_matrix(none, none);
  }

  algebra::LinearReport solve(const Vector& rhs, Vector& x, const algebra::LinearStop& stop) const override {
    Vector b(condensation_.rows()), y(condensation_.rows());
    condensation_.reduce(rhs, b);
    take(x, y);
    algebra::LinearStop inner = stop;
    if (stop.criterion)
      inner.criterion = [&](const Vector& iterate, int i, double residual) {
        Vector all(x.getMap());
        condensation_.recover(rhs, iterate, all);
        return stop.criterion(all, i, residual);
      };
    const auto report = solver_.solve(b, y, inner);
    condensation_.recover(rhs, y, x);
    return report;
  }

  double residual(const Vector& rhs, Vector& x) const override {
    Vector b(condensation_.rows()), y(condensation_.rows()), r(condensation_.rows());
    condensation_.reduce(rhs, b);
    take(x, y);
    condensation_.recover(rhs, y, x);
    return algebra::residual(*condensation_.matrix(), b, y, r);
  }

  GlobalIndex nonzeros() const override { return condensation_.matrix()->getGlobalNumEntries(); }

 private:
  /// The part of x that is not eliminated.
  void take(const Vector& x, Vector& left) const {
    const auto original = condensation_.original_row();
    const auto all = x.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto out = left.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    Kokkos::parallel_for(
        "thixis::models::left", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int row) { out(row, 0) = all(original(row), 0); });
  }

  Teuchos::RCP<const MultiVector> coordinates_left(const MultiVector& coordinates) const {
    const auto original = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), condensation_.original_row());
    const int fields = blocks_.fields, nodes = original.extent_int(0) / fields;
    auto left =
        Teuchos::rcp(new MultiVector(algebra::contiguous_map(nodes, algebra::comm_of(*membranes_.map())), coordinates.getNumVectors()));
    const auto all = coordinates.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto out = left->getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (int node = 0; node < nodes; ++node)
      for (std::size_t d = 0; d < out.extent(1); ++d) out(node, d) = all(original(fields * node) / fields, d);
    return left;
  }

  /// Buffers for the matrices of so many cells.
  void reserve(LocalIndex cells) {
    if (cells_[0].extent_int(0) >= cells) return;
    for (int alpha = 0; alpha < (membranes_.shared() ? 1 : 2); ++alpha)
      cells_[alpha] = Matrices("thixis::models::cell_matrices", cells, forms_.elements.extent(1), forms_.elements.extent(1));
  }

  const MembraneOperator& membranes_;
  const CellForms& forms_;
  Blocks blocks_;
  method::Condensation condensation_;
  algebra::Solver solver_;
  Teuchos::RCP<const MultiVector> coordinates_;
  Kokkos::View<const double*> share_;
  Matrices cells_[2];
};

}  // namespace

std::unique_ptr<ConstrainedSolver> make_condensed_solver(const MembraneOperator& membranes, const Blocks& blocks,
                                                         const algebra::LinearParams& params,
                                                         const Teuchos::RCP<const MultiVector>& coordinates) {
  return std::make_unique<CondensedSolver>(membranes, blocks, params, coordinates);
}

}  // namespace thixis::models
