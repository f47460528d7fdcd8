#include "constrained_solver.hpp"

#include "condensed_solver.hpp"

namespace thixis::models {
namespace {

using algebra::Vector;
using LocalMatrix = algebra::Matrix::local_matrix_device_type;
using Execution = algebra::Matrix::execution_space;
using Range = Kokkos::RangePolicy<Execution>;

/// Row (l, i) begins at fields² begin(l) + i fields length(l): in it the entries (m, 0), …, (m, fields-1) of each neighbour m.
template <class RowMap, class Entries>
struct Pattern {
  LocalMatrix S;
  int fields;
  RowMap row_map;
  Entries entries;

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const std::size_t begin = S.graph.row_map(l), end = S.graph.row_map(l + 1);
    for (int i = 0; i < fields; ++i) {
      std::size_t k = fields * fields * begin + i * fields * (end - begin);
      row_map(fields * l + i) = k;
      for (std::size_t e = begin; e < end; ++e)
        for (int j = 0; j < fields; ++j) entries(k++) = fields * S.graph.entries(e) + j;
    }
    if (l + 1 == S.numRows()) row_map(fields * S.numRows()) = fields * fields * end;
  }
};

template <class V>
struct Fill {
  LocalMatrix S[2];
  Blocks B;
  V contact, penalty;
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const std::size_t begin = S[0].graph.row_map(l), end = S[0].graph.row_map(l + 1);
    const int last = B.fields - 1;
    for (int i = 0; i < B.fields; ++i) {
      std::size_t k = B.fields * B.fields * begin + i * B.fields * (end - begin);
      const bool row_known = i == last && contact(l, 0) > 0;
      for (std::size_t e = begin; e < end; ++e) {
        const LocalIndex m = S[0].graph.entries(e);
        for (int j = 0; j < B.fields; ++j, ++k) {
          const double value = B.c[i][j][0] * S[0].values(e) + B.c[i][j][1] * S[1].values(e);
          const bool column_known = j == last && contact(m, 0) > 0;
          if (m == l && i == j) A.values(k) = i == last ? value + penalty(l, 0) : value;
          else A.values(k) = row_known || column_known ? 0 : value;
        }
      }
    }
  }
};

class AssembledSolver final : public ConstrainedSolver {
 public:
  AssembledSolver(const MembraneOperator& membranes, const Blocks& blocks, const algebra::LinearParams& params,
                  const Teuchos::RCP<const algebra::MultiVector>& coordinates)
      : membranes_(membranes), blocks_(blocks), solver_(params), coordinates_(coordinates) {}

  void set_matrix(const Vector& contact, const Vector& penalty) override {
    if (own_.is_null()) {
      own_ = Teuchos::rcp(new algebra::Matrix(make_graph()));
      own_->fillComplete();
    }
    const Vector contact_columns = at_columns(membranes_, contact);
    const auto known = contact_columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const LocalMatrix S = membranes_.matrix[0]->getLocalMatrixDevice();
    const Fill<std::decay_t<decltype(known)>> fill{{S, membranes_.matrix[1].is_null() ? S : membranes_.matrix[1]->getLocalMatrixDevice()},
                                                   blocks_,
                                                   known,
                                                   penalty.getLocalViewDevice(Tpetra::Access::ReadOnly),
                                                   own_->getLocalMatrixDevice()};
    Kokkos::parallel_for("thixis::models::constrained_matrix", Range(0, S.numRows()), fill);
    A_ = own_;
    solver_.set_matrix(A_, blocks_.fields, coordinates_);
  }

  void set_matrix() override {
    if (!blocks_.plain()) {
      const Vector none(membranes_.map());
      return set_matrix(none, none);
    }
    A_ = membranes_.matrix[0];
    solver_.set_matrix(A_, 1, coordinates_);
  }

  algebra::LinearReport solve(const Vector& rhs, Vector& x, const algebra::LinearStop& stop) const override {
    return solver_.solve(rhs, x, stop);
  }

  double residual(const Vector& rhs, Vector& x) const override {
    Vector r(rhs.getMap());
    return algebra::residual(*A_, rhs, x, r);
  }

  GlobalIndex nonzeros() const override {
    return blocks_.fields * blocks_.fields * static_cast<GlobalIndex>(membranes_.matrix[0]->getGlobalNumEntries());
  }

 private:
  algebra::GraphPtr make_graph() const {
    if (blocks_.fields == 1) return membranes_.matrix[0]->getCrsGraph();
    const LocalMatrix S = membranes_.matrix[0]->getLocalMatrixDevice();
    const std::size_t fields = blocks_.fields;
    using LocalGraph = algebra::Graph::local_graph_device_type;
    LocalGraph::row_map_type::non_const_type row_map("thixis::models::row_map", fields * S.numRows() + 1);
    LocalGraph::entries_type::non_const_type entries("thixis::models::entries", fields * fields * S.nnz());
    Kokkos::parallel_for("thixis::models::block_pattern", Range(0, S.numRows()),
                         Pattern<decltype(row_map), decltype(entries)>{S, blocks_.fields, row_map, entries});
    return algebra::make_graph(algebra::interlaced(membranes_.map(), blocks_.fields),
                               algebra::interlaced(membranes_.matrix[0]->getColMap(), blocks_.fields), row_map, entries);
  }

  const MembraneOperator& membranes_;
  Blocks blocks_;
  algebra::Solver solver_;
  Teuchos::RCP<const algebra::MultiVector> coordinates_;
  algebra::MatrixPtr own_;  ///< none while only B itself is asked for
  Teuchos::RCP<const algebra::Matrix> A_;
};

}  // namespace

std::unique_ptr<ConstrainedSolver> make_constrained_solver(const MembraneOperator& membranes, const Blocks& blocks,
                                                           const algebra::LinearParams& params,
                                                           const Teuchos::RCP<const algebra::MultiVector>& coordinates) {
  if (membranes.condensed) return make_condensed_solver(membranes, blocks, params, coordinates);
  return std::make_unique<AssembledSolver>(membranes, blocks, params, coordinates);
}

Vector at_columns(const MembraneOperator& membranes, const Vector& at_rows) {
  Vector at_columns(membranes.matrix[0]->getColMap());
  const auto import = membranes.matrix[0]->getGraph()->getImporter();
  if (import.is_null()) at_columns.assign(at_rows);
  else at_columns.doImport(at_rows, *import, Tpetra::INSERT);
  return at_columns;
}

}  // namespace thixis::models
