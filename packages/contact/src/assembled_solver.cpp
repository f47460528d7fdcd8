#include "constrained_solver.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<algebra::Matrix::execution_space>;

/// Row (l, i) begins at size² begin(l) + i size length(l): in it the entries (m, 0), …, (m, size-1) of each neighbour m.
template <class RowMap, class Entries>
struct Pattern {
  LocalMatrix S;
  int size;
  RowMap row_map;
  Entries entries;

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const std::size_t begin = S.graph.row_map(l), end = S.graph.row_map(l + 1);
    for (int i = 0; i < size; ++i) {
      std::size_t k = size * size * begin + i * size * (end - begin);
      row_map(size * l + i) = k;
      for (std::size_t e = begin; e < end; ++e)
        for (int j = 0; j < size; ++j) entries(k++) = size * S.graph.entries(e) + j;
    }
    if (l + 1 == S.numRows()) row_map(size * S.numRows()) = size * size * end;
  }
};

template <class View>
struct Fill {
  TransformedBlocks blocks;
  GapsOfPart<View> gaps;
  LocalMatrix S[most_matrices];
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const auto& graph = S[0].graph;
    const std::size_t begin = graph.row_map(l), end = graph.row_map(l + 1);
    const int size = blocks.part.size;
    for (std::size_t e = begin; e < end; ++e) {
      const LocalIndex m = graph.entries(e);
      Small room[most_matrices];
      const Small* c = blocks.at(l, m, room);
      for (int i = 0; i < size; ++i) {
        std::size_t to = size * size * begin + i * size * (end - begin) + size * (e - begin);
        for (int j = 0; j < size; ++j, ++to) {
          double value = 0;
          for (int k = 0; k < blocks.matrices; ++k) value += c[k](i, j) * S[k].values(e);
          if (m == l && i == j) A.values(to) = value + gaps.added(l, i);
          else A.values(to) = gaps.known(l, i) || gaps.known(m, j) ? 0 : value;
        }
      }
    }
  }
};

/// The matrix of the operator itself, of which a single mean is a multiple: nothing is copied.
class PlainSolver final : public ConstrainedSolver {
 public:
  PlainSolver(const System& system, double factor, const algebra::LinearParams& params, const algebra::Nodes& nodes)
      : A_(system.S.matrix[0]), factor_(factor), solver_(params), nodes_(nodes) {}

  void set_matrix(const Part&, const MultiVector&, const MultiVector&) override { solver_.set_matrix(A_, 1, nodes_); }

  algebra::LinearReport solve(const Vector& rhs, Vector& y, const algebra::LinearStop& stop) const override {
    Vector b(rhs, Teuchos::Copy);
    b.scale(1 / factor_);
    algebra::LinearStop inner = stop;
    inner.tolerance = stop.tolerance / factor_;
    if (stop.criterion)
      inner.criterion = [&](const Vector& iterate, int i, double residual) { return stop.criterion(iterate, i, factor_ * residual); };
    auto report = solver_.solve(b, y, inner);
    report.residual *= factor_;
    return report;
  }

  double residual(const Vector& rhs, Vector& y) const override {
    Vector r(rhs, Teuchos::Copy);
    A_->apply(y, r, Teuchos::NO_TRANS, -factor_, 1);
    return r.norm2();
  }

  GlobalIndex nonzeros() const override { return static_cast<GlobalIndex>(A_->getGlobalNumEntries()); }

 private:
  Teuchos::RCP<const algebra::Matrix> A_;
  double factor_;
  algebra::Solver solver_;
  algebra::Nodes nodes_;
};

class AssembledSolver final : public ConstrainedSolver {
 public:
  AssembledSolver(const System& system, const Part& part, const algebra::LinearParams& params, const algebra::Nodes& nodes)
      : system_(system), size_(part.size), solver_(params), nodes_(nodes), A_(Teuchos::rcp(new algebra::Matrix(make_graph()))) {
    A_->fillComplete();
  }

  void set_matrix(const Part& part, const MultiVector& contact, const MultiVector& penalty) override {
    const MultiVector contact_columns = at_columns(system_, contact);
    const auto known = contact_columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
    Fill<std::decay_t<decltype(known)>> fill{TransformedBlocks(system_, part), {part, system_.fields() - system_.gaps()}};
    for (std::size_t k = 0; k < system_.S.matrix.size(); ++k) fill.S[k] = system_.S.matrix[k]->getLocalMatrixDevice();
    fill.gaps.contact = known;
    fill.gaps.penalty = penalty.getLocalViewDevice(Tpetra::Access::ReadOnly);
    fill.A = A_->getLocalMatrixDevice();
    Kokkos::parallel_for("thixis::contact::constrained_matrix", Range(0, fill.S[0].numRows()), fill);
    solver_.set_matrix(A_, size_, nodes_);
  }

  algebra::LinearReport solve(const Vector& rhs, Vector& y, const algebra::LinearStop& stop) const override {
    return solver_.solve(rhs, y, stop);
  }

  double residual(const Vector& rhs, Vector& y) const override {
    Vector r(rhs.getMap());
    return algebra::residual(*A_, rhs, y, r);
  }

  GlobalIndex nonzeros() const override { return static_cast<GlobalIndex>(A_->getGlobalNumEntries()); }

 private:
  algebra::GraphPtr make_graph() const {
    const auto& matrix = *system_.S.matrix[0];
    if (size_ == 1) return matrix.getCrsGraph();
    const LocalMatrix S = matrix.getLocalMatrixDevice();
    const std::size_t size = size_;
    using LocalGraph = algebra::Graph::local_graph_device_type;
    LocalGraph::row_map_type::non_const_type row_map("thixis::contact::row_map", size * S.numRows() + 1);
    LocalGraph::entries_type::non_const_type entries("thixis::contact::entries", size * size * S.nnz());
    Kokkos::parallel_for("thixis::contact::block_pattern", Range(0, S.numRows()),
                         Pattern<decltype(row_map), decltype(entries)>{S, size_, row_map, entries});
    return algebra::make_graph(algebra::interlaced(system_.map(), size_), algebra::interlaced(matrix.getColMap(), size_), row_map, entries);
  }

  const System& system_;
  int size_;
  algebra::Solver solver_;
  algebra::Nodes nodes_;
  algebra::MatrixPtr A_;
};

}  // namespace

std::unique_ptr<ConstrainedSolver> make_constrained_solver(const System& system, const Part& part, const algebra::LinearParams& params,
                                                           const algebra::Nodes& nodes) {
  if (system.S.cells) return make_condensed_solver(system, part, params, nodes);
  const TransformedBlocks blocks(system, part);
  if (part.size == 1 && part.gap(0, system.fields() - system.gaps()) < 0 && blocks.frames.uniform() && blocks.matrices == 1)
    return std::make_unique<PlainSolver>(system, blocks.uniform[0](0, 0), params, nodes);
  return std::make_unique<AssembledSolver>(system, part, params, nodes);
}

void to_columns(const System& system, const MultiVector& at_rows, MultiVector& at_columns) {
  const auto import = system.S.matrix[0]->getGraph()->getImporter();
  if (import.is_null()) at_columns.assign(at_rows);
  else at_columns.doImport(at_rows, *import, Tpetra::INSERT);
}

MultiVector at_columns(const System& system, const MultiVector& at_rows) {
  MultiVector at_columns(system.S.matrix[0]->getColMap(), at_rows.getNumVectors());
  to_columns(system, at_rows, at_columns);
  return at_columns;
}

}  // namespace thixis::contact
