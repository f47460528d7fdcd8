#include <gtest/gtest.h>

#include "systems.hpp"

namespace thixis::algebra::testing {

namespace {

LinearParams params(SolverKind solver, PreconditionerKind preconditioner, int overlap = 0) {
  LinearParams p;
  p.solver = solver;
  p.preconditioner = preconditioner;
  p.overlap = overlap;
  return p;
}

/// Iterations to 1e-10.
int expect_solution(Solver& solver, const Matrix& A) {
  const Vector b = right_hand_side(A.getRowMap());
  Vector x(A.getDomainMap());
  LinearStop stop;
  stop.tolerance = 1e-10 * norm2(b);
  const LinearReport report = solver.solve(b, x, stop);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_LE(true_residual(A, b, x), stop.tolerance);
  return report.iterations;
}

/// Another matrix with this graph: values of rows and columns scaled, so that factors of the old values are of no use.
void change_values(Matrix& A) {
  A.resumeFill();
  {
    const auto local = A.getLocalMatrixHost();
    for (LocalIndex i = 0; i < local.numRows(); ++i)
      for (auto k = local.graph.row_map(i); k < local.graph.row_map(i + 1); ++k)
        local.values(k) *= 1 + 100 * static_cast<double>(A.getRowMap()->getGlobalElement(i) % 3);
  }
  A.fillComplete(A.getDomainMap(), A.getRangeMap());
}

class Setup : public ::testing::TestWithParam<LinearParams> {
 protected:
  MatrixPtr A = matrix(node_map(20 * 20, 1), poisson(20));
};

}  // namespace

TEST_P(Setup, analyses_a_graph_once_and_uses_new_values) {
  Solver solver(GetParam());
  for (int pass = 0; pass < 3; ++pass) {
    solver.set_matrix(A, 1);
    EXPECT_EQ(solver.symbolic_setups(), 1);
    Solver fresh(GetParam());
    fresh.set_matrix(A, 1);
    EXPECT_EQ(expect_solution(solver, *A), expect_solution(fresh, *A));
    change_values(*A);
  }
}
TEST_P(Setup, analyses_a_graph_once_for_several_matrix_objects) {
  Solver solver(GetParam());
  solver.set_matrix(A, 1);
  const MatrixPtr B = Teuchos::rcp(new Matrix(A->getCrsGraph()));
  B->fillComplete(A->getDomainMap(), A->getRangeMap());
  Kokkos::deep_copy(B->getLocalMatrixDevice().values, A->getLocalMatrixDevice().values);
  change_values(*B);
  solver.set_matrix(B, 1);
  expect_solution(solver, *B);
  EXPECT_EQ(solver.symbolic_setups(), 1);
}
TEST_P(Setup, analyses_another_graph_anew) {
  Solver solver(GetParam());
  solver.set_matrix(A, 1);
  expect_solution(solver, *A);
  const MatrixPtr other = matrix(node_map(13 * 13, 1), poisson(13));
  solver.set_matrix(other, 1);
  expect_solution(solver, *other);
  EXPECT_EQ(solver.symbolic_setups(), 2);
}

using K = PreconditionerKind;
INSTANTIATE_TEST_SUITE_P(all, Setup,
                         ::testing::Values(params(SolverKind::gmres, K::ilu), params(SolverKind::gmres, K::ilut),
                                           params(SolverKind::direct, K::none)));

TEST(OverlappingSetup, uses_new_values_of_other_ranks_rows) {
  const MatrixPtr A = matrix(node_map(20 * 20, 1), poisson(20));
  Solver solver(params(SolverKind::gmres, K::ilu, 2));
  solver.set_matrix(A, 1);
  change_values(*A);
  solver.set_matrix(A, 1);
  Solver fresh(params(SolverKind::gmres, K::ilu, 2));
  fresh.set_matrix(A, 1);
  EXPECT_EQ(expect_solution(solver, *A), expect_solution(fresh, *A));
}
TEST(OverlappingSetup, reduces_the_iterations_on_several_ranks) {
  const MatrixPtr A = matrix(node_map(40 * 40, 1), poisson(40));
  if (A->getComm()->getSize() == 1) GTEST_SKIP() << "one rank has nothing to overlap with";
  Solver without(params(SolverKind::gmres, K::ilu)), with(params(SolverKind::gmres, K::ilu, 3));
  without.set_matrix(A, 1);
  with.set_matrix(A, 1);
  EXPECT_LT(expect_solution(with, *A), expect_solution(without, *A));
}
TEST(SetupTime, is_counted) {
  Solver solver(params(SolverKind::gmres, K::ilu));
  EXPECT_EQ(solver.seconds_preconditioner(), 0);
  solver.set_matrix(matrix(node_map(400, 1), poisson(20)), 1);
  EXPECT_GT(solver.seconds_preconditioner(), 0);
}

}  // namespace thixis::algebra::testing
