#include "constrained_solver.hpp"
#include "thixis/algebra/structure.hpp"
#include "thixis/contact/condensation.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using method::ElementUnknowns;
using Matrices = Kokkos::View<double***, Kokkos::LayoutRight>;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// (element, size i + f): unknown i of the element, f of the part.
ElementUnknowns interlaced(const ElementUnknowns& elements, int size) {
  if (size == 1) return elements;
  const Kokkos::View<LocalIndex**, Kokkos::LayoutRight> all("thixis::contact::element_unknowns", elements.extent(0),
                                                            size * elements.extent(1));
  Kokkos::parallel_for(
      "thixis::contact::element_unknowns", Range(0, elements.extent_int(0)), KOKKOS_LAMBDA(int e) {
        for (int i = 0; i < elements.extent_int(1); ++i)
          for (int f = 0; f < size; ++f) all(e, size * i + f) = elements(e, i) < 0 ? -1 : size * elements(e, i) + f;
      });
  return all;
}

/// 1 / the number of elements that share each unknown, for the rows of this rank; 1 for interior ghosts.
Kokkos::View<double*> share_of_elements(const ElementUnknowns& elements, LocalIndex columns) {
  const Kokkos::View<double*> share("thixis::contact::share", columns);
  Kokkos::parallel_for(
      "thixis::contact::count_elements", Range(0, elements.extent_int(0)), KOKKOS_LAMBDA(int e) {
        for (int i = 0; i < elements.extent_int(1); ++i)
          if (elements(e, i) >= 0) Kokkos::atomic_add(&share(elements(e, i)), 1.0);
      });
  Kokkos::parallel_for(
      "thixis::contact::share", Range(0, columns), KOKKOS_LAMBDA(int column) {
        if (share(column) > 0) share(column) = 1 / share(column);
      });
  return share;
}

/// The matrix of a cell, gaps in contact cleared in it: summed over the cells, it is the cleared matrix. The penalty of a gap is spread
/// over the cells of its node.
template <class View>
struct Constrain {
  TransformedBlocks blocks;
  GapsOfPart<View> gaps;
  Matrices S[most_matrices];
  ElementUnknowns elements;
  LocalIndex first;
  Kokkos::View<const double*> share;
  Matrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    if (blocks.frames.uniform() && blocks.part.size == 1) combine_numbers(e);
    else combine_blocks(e);
    for (int i = 0; i < elements.extent_int(1); ++i) {
      const LocalIndex row = elements(first + e, i);
      for (int f = 0; f < blocks.part.size; ++f) constrain(e, row, f, blocks.part.size * i + f);
    }
  }
  KOKKOS_FUNCTION void combine_numbers(int e) const {
    const int count = A.extent_int(1) * A.extent_int(2);
    double* __restrict__ a = &A(e, 0, 0);
    for (int k = 0; k < blocks.matrices; ++k) {
      const double c = blocks.uniform[k](0, 0);
      const double* __restrict__ s = &S[k](e, 0, 0);
      for (int entry = 0; entry < count; ++entry) a[entry] = k == 0 ? c * s[entry] : a[entry] + c * s[entry];
    }
  }
  KOKKOS_FUNCTION void combine_blocks(int e) const {
    Small room[most_matrices];
    const int size = blocks.part.size;
    for (int i = 0; i < elements.extent_int(1); ++i)
      for (int j = 0; j < elements.extent_int(1); ++j) {
        const LocalIndex row = elements(first + e, i), column = elements(first + e, j);
        if (row < 0 || column < 0) continue;  // constrained below
        const Small* c = blocks.at(row, column, room);
        for (int f = 0; f < size; ++f)
          for (int g = 0; g < size; ++g) {
            double value = 0;
            for (int k = 0; k < blocks.matrices; ++k) value += c[k](f, g) * S[k](e, i, j);
            A(e, size * i + f, size * j + g) = value;
          }
      }
  }
  /// Of unknowns that are no rows, 1 stays on the diagonal.
  KOKKOS_FUNCTION void constrain(int e, LocalIndex row, int f, int at) const {
    const bool known = row < 0 || gaps.known(row, f);
    const double diagonal = row < 0 ? 1 : A(e, at, at) + (gaps.added(row, f) == 0 ? 0 : share(row) * gaps.added(row, f));
    for (int j = 0; known && j < A.extent_int(1); ++j) A(e, at, j) = A(e, j, at) = 0;
    A(e, at, at) = diagonal;
  }
};

class CondensedSolver final : public ConstrainedSolver {
 public:
  CondensedSolver(const System& system, const Part& part, const algebra::LinearParams& params, const algebra::Nodes& nodes)
      : system_(system),
        size_(part.size),
        condensation_(algebra::interlaced(system.map(), size_), algebra::interlaced(system.S.matrix[0]->getColMap(), size_),
                      interlaced(cells().elements, size_), size_ * cells().interior,
                      cells().symmetric ? LocalForm::positive_definite : LocalForm::general),
        solver_(params),
        nodes_(nodes_left(nodes)) {
    if (part.coordinate[part.size - 1] >= system.fields() - system.gaps())
      share_ = share_of_elements(cells().elements, algebra::local_columns(*system.S.matrix[0]));
  }

  void set_matrix(const Part& part, const MultiVector& contact, const MultiVector& penalty) override {
    const MultiVector contact_columns = at_columns(system_, contact), penalty_columns = at_columns(system_, penalty);
    const auto known = contact_columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
    Constrain<std::decay_t<decltype(known)>> kernel{TransformedBlocks(system_, part), {part, system_.fields() - system_.gaps()}};
    kernel.elements = cells().elements;
    kernel.gaps.contact = known;
    kernel.gaps.penalty = penalty_columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
    kernel.share = share_;
    condensation_.set_matrix([&](LocalIndex first, const Matrices& A) {
      reserve(A.extent_int(0));
      for (std::size_t k = 0; k < cells().form.size(); ++k) {
        kernel.S[k] = Kokkos::subview(local_[k], std::pair(0, A.extent_int(0)), Kokkos::ALL, Kokkos::ALL);
        cells().form[k]->matrices(first, kernel.S[k]);
      }
      kernel.first = first;
      kernel.A = A;
      Kokkos::parallel_for("thixis::contact::constrain", Range(0, A.extent_int(0)), kernel);
    });
    solver_.set_matrix(condensation_.matrix(), size_, nodes_);
  }

  algebra::LinearReport solve(const Vector& rhs, Vector& x, const algebra::LinearStop& stop) const override {
    Vector b(condensation_.rows()), y(condensation_.rows());
    condensation_.reduce(rhs, b);
    take(x, y);
    algebra::LinearStop inner = stop;
    if (stop.criterion)
      inner.criterion = [&](const Vector& iterate, int i, double residual) {
        condensation_.recover(rhs, iterate, x);
        return stop.criterion(x, i, residual);
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

  GlobalIndex nonzeros() const override { return static_cast<GlobalIndex>(condensation_.matrix()->getGlobalNumEntries()); }

 private:
  /// The part of x that is not eliminated.
  void take(const Vector& x, Vector& left) const {
    const auto original = condensation_.original_row();
    const auto all = x.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto out = left.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    Kokkos::parallel_for(
        "thixis::contact::left", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int row) { out(row, 0) = all(original(row), 0); });
  }

  /// Of the unknowns that are not eliminated: their places, and the coarser functions there.
  algebra::Nodes nodes_left(const algebra::Nodes& nodes) const {
    const auto original = condensation_.original_row();
    const int size = size_;
    const Kokkos::View<LocalIndex*> node("thixis::contact::nodes_left", original.extent(0) / size);
    Kokkos::parallel_for(
        "thixis::contact::nodes_left", Range(0, node.extent_int(0)),
        KOKKOS_LAMBDA(int left) { node(left) = original(size * left) / size; });
    const auto map = algebra::contiguous_map(node.extent_int(0), algebra::comm_of(*system_.map()));
    algebra::Nodes left = nodes;
    if (!nodes.coordinates.is_null()) left.coordinates = select(*nodes.coordinates, map, node);
    if (!nodes.below.empty()) left.below[0] = algebra::select_rows(*nodes.below[0], map, node);
    return left;
  }

  static Teuchos::RCP<const MultiVector> select(const MultiVector& values, const algebra::MapPtr& map,
                                                const Kokkos::View<const LocalIndex*>& selected) {
    const auto left = Teuchos::rcp(new MultiVector(map, values.getNumVectors()));
    const auto all = values.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto out = left->getLocalViewDevice(Tpetra::Access::OverwriteAll);
    Kokkos::parallel_for(
        "thixis::contact::select", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int row) {
          for (int d = 0; d < out.extent_int(1); ++d) out(row, d) = all(selected(row), d);
        });
    return left;
  }

  /// Their forms may be others at every set_matrix.
  const CellForms& cells() const { return *system_.S.cells; }

  /// Buffers for the matrices of so many cells.
  void reserve(LocalIndex count) {
    const auto width = cells().elements.extent(1);
    local_.resize(cells().form.size());
    for (auto& matrices : local_)
      if (matrices.extent_int(0) < count) matrices = Matrices("thixis::contact::cell_matrices", count, width, width);
  }

  const System& system_;
  int size_;
  Condensation condensation_;
  algebra::Solver solver_;
  algebra::Nodes nodes_;               ///< that are left
  Kokkos::View<const double*> share_;  ///< of penalties, where there are gaps
  std::vector<Matrices> local_;
};

}  // namespace

std::unique_ptr<ConstrainedSolver> make_condensed_solver(const System& system, const Part& part, const algebra::LinearParams& params,
                                                         const algebra::Nodes& nodes) {
  return std::make_unique<CondensedSolver>(system, part, params, nodes);
}

}  // namespace thixis::contact
