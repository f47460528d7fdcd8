#include <gtest/gtest.h>

#include <cmath>

#include "systems.hpp"
#include "thixis/core/error.hpp"

namespace thixis::algebra::testing {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

LinearParams params(SolverKind solver, PreconditionerKind preconditioner = PreconditionerKind::none) {
  LinearParams p;
  p.solver = solver;
  p.preconditioner = preconditioner;
  return p;
}

/// Starts from ones.
struct Case {
  Case(const LinearParams& p, const Row& row, GlobalIndex nodes, int fields = 1, double value_of_b = 1)
      : A(matrix(node_map(nodes, fields), row)), b(A->getRowMap()), x(A->getDomainMap()) {
    b.putScalar(value_of_b);
    x.putScalar(1);
    Solver solver(p);
    solver.set_matrix(A, fields);
    LinearStop stop;
    stop.tolerance = 1e-10 * norm2(b);
    report = solver.solve(b, x, stop);
  }
  MatrixPtr A;
  Vector b, x;
  LinearReport report;
};

Row scaled(const Row& row, double factor) {
  return [=](GlobalIndex i, auto& columns, auto& values) {
    row(i, columns, values);
    for (double& v : values) v *= factor;
  };
}
Row with_entry(const Row& row, GlobalIndex where, double value) {
  return [=](GlobalIndex i, auto& columns, auto& values) {
    row(i, columns, values);
    if (i == where) values[1] = value;
  };
}

class Failure : public ::testing::TestWithParam<LinearParams> {};

}  // namespace

TEST(Gmres, does_not_add_a_correction_that_is_not_finite) {
  const Row tiny = [](GlobalIndex i, auto& columns, auto& values) {
    columns.push_back(i);
    values.push_back(1e-100);
  };
  const Case run(params(SolverKind::gmres), tiny, 144, 1, 1e100);
  EXPECT_FALSE(run.report.converged);
  EXPECT_TRUE(std::isfinite(run.report.residual)) << "of the x that is left";
  EXPECT_FALSE(run.report.reason.empty());
  EXPECT_EQ(run.x.normInf(), 1);
}

TEST_P(Failure, of_a_matrix_with_nan_or_infinity_is_reported_and_leaves_x_alone) {
  for (const double bad : {nan, infinity}) {
    const Case run(GetParam(), with_entry(poisson(12), 100, bad), 144);
    EXPECT_FALSE(run.report.converged);
    EXPECT_EQ(run.report.reason, "the matrix holds NaN or infinity");
    EXPECT_DOUBLE_EQ(norm2(run.x), 12);
  }
}
TEST_P(Failure, of_a_right_hand_side_with_nan_is_reported_and_leaves_x_alone) {
  const Case run(GetParam(), poisson(12), 144, 1, nan);
  EXPECT_FALSE(run.report.converged);
  EXPECT_EQ(run.report.reason, "the right-hand side holds NaN or infinity");
  EXPECT_DOUBLE_EQ(norm2(run.x), 12);
}
TEST_P(Failure, of_a_singular_matrix_is_reported_without_nan) {
  const Case run(GetParam(), neumann(12), 144);
  EXPECT_FALSE(run.report.converged);
  EXPECT_FALSE(run.report.reason.empty());
  EXPECT_TRUE(std::isfinite(norm2(run.x)));
}
TEST_P(Failure, of_a_matrix_of_zeros_is_reported_without_nan) {
  const Case run(GetParam(), scaled(poisson(12), 0), 144);
  EXPECT_FALSE(run.report.converged);
  EXPECT_FALSE(run.report.reason.empty());
  EXPECT_DOUBLE_EQ(norm2(run.x), 12);
}
TEST_P(Failure, is_forgotten_when_a_good_matrix_comes) {
  Solver solver(GetParam());
  solver.set_matrix(matrix(node_map(144, 1), with_entry(poisson(12), 100, nan)), 1);
  solver.set_matrix(matrix(node_map(144, 1), neumann(12)), 1);
  const MatrixPtr A = matrix(node_map(144, 1), poisson(12));
  solver.set_matrix(A, 1);
  const Vector b = right_hand_side(A->getRowMap());
  Vector x(A->getDomainMap());
  LinearStop stop;
  stop.tolerance = 1e-10 * norm2(b);
  EXPECT_TRUE(solver.solve(b, x, stop).converged);
}

using K = PreconditionerKind;
INSTANTIATE_TEST_SUITE_P(all, Failure,
                         ::testing::Values(params(SolverKind::gmres), params(SolverKind::gmres, K::ilu), params(SolverKind::gmres, K::ilut),
                                           params(SolverKind::cg), params(SolverKind::cg, K::ilu), params(SolverKind::direct)));

TEST(DirectSolver, notices_a_singular_matrix_even_if_the_system_has_solutions) {
  const Case run(params(SolverKind::direct), neumann(12), 144, 1, 0);
  EXPECT_FALSE(run.report.converged);
  EXPECT_EQ(run.report.reason.rfind("the matrix is singular: ", 0), 0u) << run.report.reason;
}
TEST(DirectSolver, takes_badly_scaled_rows_for_what_they_are) {
  const Row laplace = poisson(12);
  const Case run(
      params(SolverKind::direct),
      [&](GlobalIndex i, auto& columns, auto& values) {
        laplace(i, columns, values);
        for (std::size_t k = 0; k < values.size(); ++k) values[k] *= std::pow(10., i % 9 - static_cast<double>(columns[k] % 7));
      },
      144);
  EXPECT_TRUE(run.report.converged) << run.report.reason;
}

TEST(Cg, refuses_a_matrix_that_is_not_positive_definite) {
  const Case run(params(SolverKind::cg), scaled(poisson(12), -1), 144);
  EXPECT_FALSE(run.report.converged);
  EXPECT_EQ(run.report.reason, "the matrix is not positive definite, so cg can not solve the system");
}
TEST(Cg, is_not_deceived_by_two_wrong_signs) {
  const Case run(params(SolverKind::cg, K::ilu), scaled(poisson(12), -1), 144);
  EXPECT_FALSE(run.report.converged);
  EXPECT_EQ(run.report.reason, "the preconditioner is not positive definite, so cg can not use it");
}
TEST(Cg, wants_a_symmetric_preconditioner) { EXPECT_THROW(Solver(params(SolverKind::cg, K::ilut)), core::InputError); }

TEST(Ilu, reports_a_zero_pivot) {
  // The unknown with the zero diagonal comes first.
  const Case run(
      params(SolverKind::gmres, K::ilu),
      [](GlobalIndex i, auto& columns, auto& values) {
        columns = {i - i % 2, i - i % 2 + 1};
        if (i % 2 == 0) values = {0, 1};
        else values = {1, 1};
      },
      10, 2);
  EXPECT_FALSE(run.report.converged);
  EXPECT_EQ(run.report.reason, "the incomplete factorization has a zero pivot");
}
TEST(Multigrid, refuses_a_saddle_system) {
  const MatrixPtr P = matrix(node_map(100, 1), poisson(10));  // any functions below
  for (const auto& [kind, name, nodes] : {std::tuple(K::muelu, "'muelu'", Nodes{}), std::tuple(K::multigrid, "'multigrid'", Nodes{}),
                                          std::tuple(K::multigrid, "'multigrid'", Nodes{Teuchos::null, {P}})}) {
    Solver solver(params(SolverKind::gmres, kind));
    try {
      solver.set_matrix(matrix(node_map(100, 3), membranes(10)), 3, nodes);
      FAIL() << name;
    } catch (const core::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

}  // namespace thixis::algebra::testing
