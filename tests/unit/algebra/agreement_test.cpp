#include <gtest/gtest.h>

#include "systems.hpp"

namespace thixis::algebra::testing {

namespace {

LinearParams params(SolverKind solver, PreconditionerKind preconditioner) {
  LinearParams p;
  p.solver = solver;
  p.preconditioner = preconditioner;
  return p;
}

void expect_agreement(const LinearParams& p, const MatrixPtr& A, int fields, const Teuchos::RCP<const MultiVector>& xy) {
  const Vector b = right_hand_side(A->getRowMap());
  LinearStop stop;
  stop.tolerance = 1e-11 * norm2(b);

  Solver direct(params(SolverKind::direct, PreconditionerKind::none));
  direct.set_matrix(A, fields, {xy, {}});
  Vector reference(A->getDomainMap());
  const LinearReport by_direct = direct.solve(b, reference, stop);
  ASSERT_TRUE(by_direct.converged) << by_direct.reason;
  ASSERT_LE(true_residual(*A, b, reference), 1e-12 * norm2(b));

  Solver solver(p);
  solver.set_matrix(A, fields, {xy, {}});
  Vector x(A->getDomainMap());
  x.putScalar(0.5);
  const LinearReport report = solver.solve(b, x, stop);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_FALSE(report.by_criterion);
  EXPECT_DOUBLE_EQ(report.residual, true_residual(*A, b, x));
  EXPECT_LE(report.residual, stop.tolerance);
  EXPECT_LE(difference(x, reference), 1e-8);
}

class PoissonSolvers : public ::testing::TestWithParam<LinearParams> {};
class MembraneSolvers : public ::testing::TestWithParam<LinearParams> {};

LinearParams overlapping(SolverKind solver, PreconditionerKind preconditioner, int level = 0) {
  LinearParams p = params(solver, preconditioner);
  p.overlap = 1;
  p.ilu_level = level;
  return p;
}
LinearParams restarted(PreconditionerKind preconditioner) {
  LinearParams p = params(SolverKind::gmres, preconditioner);
  p.restart = 20;
  return p;
}

}  // namespace

TEST_P(PoissonSolvers, agree_with_the_direct_solve) {
  expect_agreement(GetParam(), matrix(node_map(40 * 40, 1), poisson(40)), 1, coordinates(40));
}
TEST_P(PoissonSolvers, agree_with_the_direct_solve_if_a_rank_has_no_rows) {
  const auto empty = Distribution::last_rank_empty;
  expect_agreement(GetParam(), matrix(node_map(30 * 30, 1, empty), poisson(30)), 1, coordinates(30, empty));
}
TEST_P(PoissonSolvers, solve_systems_of_four_rows) { expect_agreement(GetParam(), matrix(node_map(4, 1), poisson(2)), 1, coordinates(2)); }
TEST_P(PoissonSolvers, solve_systems_of_one_row) { expect_agreement(GetParam(), matrix(node_map(1, 1), poisson(1)), 1, coordinates(1)); }
TEST_P(PoissonSolvers, know_that_a_system_without_rows_is_solved) {
  Solver solver(GetParam());
  const MatrixPtr A = matrix(node_map(0, 1), poisson(0));
  solver.set_matrix(A, 1, {coordinates(0), {}});
  Vector b(A->getRangeMap()), x(A->getDomainMap());
  const LinearReport report = solver.solve(b, x, LinearStop());
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.residual, 0);
}

TEST_P(MembraneSolvers, agree_with_the_direct_solve) {
  expect_agreement(GetParam(), matrix(node_map(20 * 20, 3), membranes(20)), 3, Teuchos::null);
}

using K = PreconditionerKind;
INSTANTIATE_TEST_SUITE_P(all, PoissonSolvers,
                         ::testing::Values(params(SolverKind::gmres, K::none), params(SolverKind::gmres, K::ilu),
                                           params(SolverKind::gmres, K::ilut), params(SolverKind::gmres, K::muelu), restarted(K::none),
                                           restarted(K::ilu), overlapping(SolverKind::gmres, K::ilu, 1),
                                           overlapping(SolverKind::gmres, K::ilut), params(SolverKind::cg, K::none),
                                           params(SolverKind::cg, K::ilu), overlapping(SolverKind::cg, K::ilu),
                                           params(SolverKind::cg, K::muelu), params(SolverKind::direct, K::none)));
INSTANTIATE_TEST_SUITE_P(all, MembraneSolvers,
                         ::testing::Values(params(SolverKind::gmres, K::none), params(SolverKind::gmres, K::ilu),
                                           params(SolverKind::gmres, K::ilut), overlapping(SolverKind::gmres, K::ilu, 2),
                                           overlapping(SolverKind::gmres, K::ilut), params(SolverKind::direct, K::none)));

}  // namespace thixis::algebra::testing
