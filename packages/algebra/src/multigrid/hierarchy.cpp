#include "multigrid/hierarchy.hpp"

#include <deque>

#include "factorization.hpp"
#include "multigrid/aggregation.hpp"
#include "multigrid/coupled.hpp"
#include "multigrid/galerkin.hpp"
#include "multigrid/gauss_seidel.hpp"
#include "thixis/core/assert.hpp"

namespace thixis::algebra {
namespace {

constexpr GlobalIndex small_rows = 400;         ///< no coarser system is made
constexpr GlobalIndex factorized_rows = 20000;  ///< the coarsest system is factorized
/// Truncation may leave coarse functions that depend on each other. This part of the diagonal makes their system definite; what the
/// coarsest correction loses by it is of the same size.
constexpr double definite = 1e-9;

struct Strengthen {
  Matrix::local_matrix_device_type A;  ///< updated

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    for (auto k = A.graph.row_map(i); k < A.graph.row_map(i + 1); ++k)
      if (A.graph.entries(k) == i) A.values(k) *= 1 + definite;
  }
};

/// A_0^{-1}, or near it.
class Coarsest {
 public:
  void set_matrix(const MatrixPtr& A, int fields) {
    const auto local = A->getLocalMatrixDevice();
    Kokkos::parallel_for("thixis::algebra::strengthen", Kokkos::RangePolicy<Node::execution_space>(0, local.numRows()), Strengthen{local});
    const bool small = static_cast<GlobalIndex>(A->getGlobalNumRows()) <= factorized_rows;
    if (small) return lu_.set_matrix(A);
    if (!aggregation_) aggregation_ = make_aggregation("multigrid");
    aggregation_->set_matrix(A, fields, {});
  }
  void solve(const Vector& b, Vector& x) const {
    if (aggregation_) aggregation_->inverse()->apply(b, x);
    else lu_.solve(b, x);
  }

 private:
  Factorization lu_;
  std::unique_ptr<Preconditioner> aggregation_;
};

/// A level with a coarser one below it.
struct Grid {
  GaussSeidel smoother;
  Interpolation from_coarse;
  Galerkin coarse;
  mutable Vector r, coarse_b, coarse_x;  ///< room

  Grid(const Teuchos::RCP<const Matrix>& A, const Teuchos::RCP<const Matrix>& P)
      : smoother(A->getCrsGraph()),
        from_coarse(P),
        coarse(A, from_coarse),
        r(A->getRowMap()),
        coarse_b(P->getDomainMap()),
        coarse_x(P->getDomainMap()) {}
  Grid(const Grid&) = delete;
  Grid& operator=(const Grid&) = delete;
};

class Cycle final : public Operator {
 public:
  /// All symbolic work: A is the finest matrix, below: P_1, P_2, … at its rows.
  Cycle(const Teuchos::RCP<const Matrix>& A, const std::vector<Teuchos::RCP<const Matrix>>& below) : map_(A->getRowMap()) {
    Teuchos::RCP<const Matrix> level = A;
    for (const auto& P : below) {
      if (static_cast<GlobalIndex>(level->getGlobalNumRows()) <= small_rows && !grids_.empty()) break;
      grids_.emplace_back(level, P);
      level = grids_.back().coarse.product();
    }
  }

  void set_matrix(const Matrix& A, int fields) {
    const Matrix* level = &A;
    for (Grid& grid : grids_) {
      grid.smoother.set_matrix(*level);
      grid.coarse.set_matrix(*level, coupled_rows(*level));
      level = grid.coarse.product().get();
    }
    coarsest_.set_matrix(grids_.back().coarse.product(), fields);
  }

  MapPtr getDomainMap() const override { return map_; }
  MapPtr getRangeMap() const override { return map_; }
  void apply(const MultiVector& b, MultiVector& x, Teuchos::ETransp, double alpha, double beta) const override {
    for (std::size_t j = 0; j < b.getNumVectors(); ++j) {
      const auto out = x.getVectorNonConst(j);
      if (alpha == 1 && beta == 0) {
        solve(0, *b.getVector(j), *out);
      } else {
        Vector y(map_);
        solve(0, *b.getVector(j), y);
        out->update(alpha, y, beta);
      }
    }
  }

 private:
  void solve(std::size_t level, const Vector& b, Vector& x) const {
    if (level == grids_.size()) return coarsest_.solve(b, x);
    const Grid& grid = grids_[level];
    grid.smoother.forward(b, x, grid.r);
    grid.from_coarse.restrict_to_coarse(grid.r, grid.coarse_b);
    solve(level + 1, grid.coarse_b, grid.coarse_x);
    grid.from_coarse.add(grid.coarse_x, x);
    grid.smoother.backward(b, x);
  }

  MapPtr map_;
  std::deque<Grid> grids_;
  Coarsest coarsest_;
};

class Multigrid final : public Preconditioner {
 public:
  void set_matrix(const Teuchos::RCP<const Matrix>& A, int fields, const Nodes& nodes) override {
    if (nodes.below.empty()) {
      if (!aggregation_) aggregation_ = make_aggregation("multigrid");
      return aggregation_->set_matrix(A, fields, nodes);
    }
    aggregation_.reset();
    require_diagonal(*A, "multigrid");
    if (graph_ != A->getCrsGraph()) make_cycle(A, fields, nodes);
    cycle_->set_matrix(*A, fields);
  }
  Teuchos::RCP<const Operator> inverse() const override {
    if (aggregation_) return aggregation_->inverse();
    return cycle_;
  }
  int symbolic_setups() const override { return aggregation_ ? aggregation_->symbolic_setups() : setups_; }

 private:
  void make_cycle(const Teuchos::RCP<const Matrix>& A, int fields, const Nodes& nodes) {
    std::vector<Teuchos::RCP<const Matrix>> below;
    for (const auto& P : nodes.below) below.push_back(interlaced(P, fields));
    THIXIS_ASSERT(below.front()->getRangeMap()->isSameAs(*A->getRowMap()), "coarse functions are known at the nodes of the system");
    cycle_ = Teuchos::rcp(new Cycle(A, below));
    graph_ = A->getCrsGraph();
    ++setups_;
  }

  std::unique_ptr<Preconditioner> aggregation_;  ///< where nothing is below
  Teuchos::RCP<Cycle> cycle_;
  GraphPtr graph_;
  int setups_ = 0;
};

}  // namespace

std::unique_ptr<Preconditioner> make_multigrid() { return std::make_unique<Multigrid>(); }

}  // namespace thixis::algebra
