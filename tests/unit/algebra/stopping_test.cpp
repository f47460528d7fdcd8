#include <gtest/gtest.h>

#include <cmath>

#include "systems.hpp"

namespace thixis::algebra::testing {

namespace {

struct Look {
  int iteration;
  double residual, true_residual;
};

class Stopping : public ::testing::TestWithParam<SolverKind> {
 protected:
  LinearParams params() const {
    LinearParams p;
    p.solver = GetParam();
    p.preconditioner = PreconditionerKind::ilu;
    p.restart = 7;
    return p;
  }
  LinearReport solve(const LinearParams& p, const LinearStop& stop) {
    Solver solver(p);
    solver.set_matrix(A, 1);
    x.putScalar(0);
    return solver.solve(b, x, stop);
  }

  MatrixPtr A = matrix(node_map(24 * 24, 1), poisson(24));
  Vector b = right_hand_side(A->getRowMap());
  Vector x{A->getDomainMap()};
};

}  // namespace

TEST_P(Stopping, criterion_sees_the_iterates_at_the_multiples_of_check_every_through_restarts) {
  std::vector<Look> looks;
  LinearStop stop;
  stop.tolerance = 1e-9 * norm2(b);
  stop.check_every = 5;
  stop.criterion = [&](const Vector& xi, int i, double r) {
    looks.push_back({i, r, true_residual(*A, b, xi)});
    return false;
  };
  const LinearReport report = solve(params(), stop);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_FALSE(report.by_criterion);
  ASSERT_EQ(static_cast<int>(looks.size()), (report.iterations - 1) / 5);
  ASSERT_GE(looks.size(), 3u);
  for (std::size_t k = 0; k < looks.size(); ++k) {
    EXPECT_EQ(looks[k].iteration, 5 * static_cast<int>(k + 1));
    EXPECT_NEAR(looks[k].residual, looks[k].true_residual, 1e-6 * looks[k].true_residual);
  }
}

TEST_P(Stopping, looking_does_not_change_the_iteration) {
  LinearStop stop;
  stop.tolerance = 1e-9 * norm2(b);
  const LinearReport unseen = solve(params(), stop);
  stop.check_every = 1;
  stop.criterion = [](const Vector&, int, double) { return false; };
  const LinearReport seen = solve(params(), stop);
  EXPECT_EQ(seen.iterations, unseen.iterations);
  EXPECT_NEAR(seen.residual, unseen.residual, 1e-6 * unseen.residual);
}

TEST_P(Stopping, criterion_ends_the_solve_with_the_iterate_that_it_saw) {
  LinearStop stop;
  stop.check_every = 4;
  Vector seen(x.getMap());
  stop.criterion = [&](const Vector& xi, int i, double) {
    Tpetra::deep_copy(seen, xi);
    return i == 12;
  };
  const LinearReport report = solve(params(), stop);
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE(report.by_criterion);
  EXPECT_EQ(report.iterations, 12);
  EXPECT_DOUBLE_EQ(report.residual, true_residual(*A, b, x));
  EXPECT_LE(difference(x, seen), 1e-12);
}

TEST_P(Stopping, iteration_limit_is_no_convergence) {
  LinearParams p = params();
  p.max_iterations = 9;
  LinearStop stop;
  stop.tolerance = 1e-9 * norm2(b);
  const LinearReport report = solve(p, stop);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 9);
  EXPECT_EQ(report.reason, "9 iterations were not enough");
  EXPECT_DOUBLE_EQ(report.residual, true_residual(*A, b, x));
  EXPECT_LT(report.residual, norm2(b));
}

TEST_P(Stopping, unreachable_tolerance_ends_in_stagnation_at_rounding_level) {
  const LinearReport report = solve(params(), LinearStop());
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.reason.find("stagnates"), std::string::npos) << report.reason;
  EXPECT_LE(report.residual, 1e-13 * norm2(b));
  EXPECT_DOUBLE_EQ(report.residual, true_residual(*A, b, x));
}

TEST_P(Stopping, criterion_is_asked_once_more_about_an_iterate_that_can_not_improve) {
  LinearStop stop;
  stop.check_every = 1000;
  int asked = 0;
  stop.criterion = [&](const Vector&, int, double) { return ++asked == 1; };
  const LinearReport report = solve(params(), stop);
  EXPECT_EQ(asked, 1);
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE(report.by_criterion);
}

TEST_P(Stopping, a_solution_as_initial_guess_needs_no_iteration) {
  LinearStop stop;
  stop.tolerance = 1e-9 * norm2(b);
  ASSERT_TRUE(solve(params(), stop).converged);
  Solver solver(params());
  solver.set_matrix(A, 1);
  const LinearReport report = solver.solve(b, x, stop);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
}

TEST_P(Stopping, a_right_hand_side_of_zero_is_solved_by_zero) {
  b.putScalar(0);
  const LinearReport report = solve(params(), LinearStop());
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(norm2(x), 0);
}

/// Rows of sizes 1 to 1e-9: the recursion loses digits, so what counts is b - A x.
TEST_P(Stopping, converged_means_that_the_true_residual_meets_the_tolerance) {
  if (GetParam() == SolverKind::cg) GTEST_SKIP() << "the matrix is not symmetric";
  const Row laplace = poisson(24);
  A = matrix(node_map(24 * 24, 1), [&](GlobalIndex row, auto& columns, auto& values) {
    laplace(row, columns, values);
    for (double& v : values) v *= std::pow(10., -static_cast<double>(row % 10));
  });
  LinearParams p = params();
  p.preconditioner = PreconditionerKind::none;
  p.restart = 300;
  for (const double relative : {1e-6, 1e-10, 1e-14}) {
    LinearStop stop;
    stop.tolerance = relative * norm2(b);
    const LinearReport report = solve(p, stop);
    EXPECT_DOUBLE_EQ(report.residual, true_residual(*A, b, x));
    EXPECT_EQ(report.converged, report.residual <= stop.tolerance) << report.reason;
  }
}

INSTANTIATE_TEST_SUITE_P(of, Stopping, ::testing::Values(SolverKind::gmres, SolverKind::cg),
                         [](const auto& instance) { return instance.param == SolverKind::gmres ? "gmres" : "cg"; });

}  // namespace thixis::algebra::testing
