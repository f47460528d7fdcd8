#include <gtest/gtest.h>

#include <cmath>

#include "dense_problem.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/core/error.hpp"

namespace thixis::complementarity::test {
namespace {

StoppingParams rule(StoppingRule rule) {
  StoppingParams stopping;
  stopping.rule = rule;
  return stopping;
}

TEST(Stopping, exact_asks_the_linear_solver_for_its_tolerance_times_the_right_hand_side) {
  DenseProblem problem(string_over_obstacle(16));
  StoppingParams stopping;
  stopping.linear_tolerance = 1e-7;
  algebra::Vector X(problem.map());
  newton(problem, X, {}, stopping, 0);
  EXPECT_NEAR(problem.tolerances.front(), 1e-7 * problem.reference_norm(), 1e-20);
}

TEST(Stopping, never_asks_for_so_little_that_the_iterate_need_not_move) {
  DenseProblem problem(string_over_obstacle(16));
  problem.linear.rate = 0.5;
  StoppingParams stopping;
  stopping.linear_tolerance = 0.5;
  NewtonParams params;
  params.c_function = CFunction::fischer_burmeister;
  algebra::Vector X(problem.map());
  const NewtonReport report = newton(problem, X, params, stopping, 0);
  EXPECT_TRUE(report.converged) << report.why;
}

TEST(Stopping, absolute_tolerance_ends_a_run_without_forces) {
  DenseData data = string_over_obstacle(16);
  data.F[0].assign(data.n, 0);
  DenseProblem problem(data);
  StoppingParams stopping;
  stopping.absolute_tolerance = 1e-3;
  algebra::Vector X = problem.vector([](int field, int) { return field == 0 ? 1e-6 : 0.0; });
  EXPECT_EQ(newton(problem, X, {}, stopping, 0).steps, 0);
  stopping.absolute_tolerance = 0;
  const NewtonReport report = newton(problem, X, {}, stopping, 0);
  EXPECT_TRUE(report.converged) << report.why;
  EXPECT_LT(X.normInf(), 1e-14);
}

TEST(Stopping, inexact_saves_linear_iterations_and_reaches_the_same_residual) {
  NewtonReport reports[2];
  for (const bool inexact : {false, true}) {
    DenseProblem problem(string_over_obstacle(32));
    problem.linear.rate = 0.8;
    NewtonParams params;
    params.c_function = CFunction::fischer_burmeister;
    params.max_iterations = 1000;
    algebra::Vector X(problem.map());
    reports[inexact] = newton(problem, X, params, rule(inexact ? StoppingRule::inexact : StoppingRule::exact), 2);
    EXPECT_TRUE(reports[inexact].converged) << reports[inexact].why;
    EXPECT_LE(reports[inexact].residuals.back(), 1e-9 * problem.reference_norm());
  }
  EXPECT_LT(reports[1].linear_iterations, reports[0].linear_iterations);
  EXPECT_GE(reports[1].steps, reports[0].steps);
}

/// |R_alg|/|B| <= alpha |R(X^i)|/|(F, 0)| at the last look, and not at the ones before.
TEST(Stopping, inexact_stops_at_the_first_look_where_the_rule_holds) {
  DenseProblem problem(string_over_obstacle(32));
  problem.linear.rate = 0.7;
  NewtonParams params;
  params.max_iterations = 1;
  std::vector<LinearRecord> looks;
  NewtonObserver observer;
  observer.linear = [&](const LinearRecord& look) { looks.push_back(look); };
  algebra::Vector X(problem.map());
  const NewtonReport report = newton(problem, X, params, rule(StoppingRule::inexact), 1, observer);
  ASSERT_FALSE(looks.empty());
  EXPECT_EQ(looks.back().step, 1);
  EXPECT_EQ(looks.back().iteration, report.linear_iterations);
  EXPECT_LE(looks.back().residual, 0.3 * report.residuals.back() * (1 + 1e-12));

  DenseProblem before(string_over_obstacle(32));
  before.linear.rate = 0.7;
  before.linear.max_iterations = report.linear_iterations - 1;
  algebra::Vector Y(before.map());
  const NewtonReport earlier = newton(before, Y, params, {}, 0);
  EXPECT_GT(looks[looks.size() - 2].residual, 0.3 * earlier.residuals.back());
}

TEST(Stopping, a_linear_solve_stopped_early_does_not_make_an_unchanged_contact_set_a_solution) {
  DenseProblem problem(string_over_obstacle(32));
  problem.linear.rate = 0.9;
  problem.rhs_factor = 10;  // |R_alg|/|B| is small from the first look on, and most systems are left early
  algebra::Vector X(problem.map());
  NewtonParams params;
  params.max_iterations = 2000;
  const NewtonReport report = newton(problem, X, params, rule(StoppingRule::inexact), 2);
  EXPECT_TRUE(report.converged) << report.why;
  EXPECT_LT(report.residuals.back(), 1e-8 * problem.reference_norm());
}

TEST(Stopping, one_unfinished_linear_solve_is_forgiven_two_are_not) {
  DenseProblem problem(string_over_obstacle(32));
  problem.linear.rate = 0.7;
  problem.linear.max_iterations = 10;
  std::vector<std::string> messages;
  NewtonObserver observer;
  observer.message = [&](const std::string& sentence) { messages.push_back(sentence); };
  algebra::Vector X(problem.map());
  const NewtonReport report = newton(problem, X, {}, {}, 0, observer);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.steps, 1);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("too few iterations"), std::string::npos) << messages[0];
  EXPECT_NE(report.why.find("second time"), std::string::npos) << report.why;
  EXPECT_NE(report.advice.find("linear/solver = direct"), std::string::npos) << report.advice;
  EXPECT_GT(X.norm2(), 0);
}

TEST(Stopping, a_linear_solve_down_to_the_rounding_of_what_it_finds_is_no_failure) {
  class Rounded : public DenseProblem {
   public:
    Rounded() : DenseProblem(string_over_obstacle(32)) {}
    double noise(const algebra::Vector& X) const override { return X.norm2() > 0 ? reference_norm() : 0; }
  };
  Rounded problem;
  problem.linear.rate = 0.7;
  problem.linear.max_iterations = 10;
  int messages = 0;
  NewtonObserver observer;
  observer.message = [&](const std::string&) { ++messages; };
  algebra::Vector X(problem.map());
  EXPECT_TRUE(newton(problem, X, {}, {}, 0, observer).converged);
  EXPECT_EQ(messages, 0);
}

TEST(Stopping, a_linear_solve_that_achieves_nothing_ends_the_run_at_the_start) {
  DenseProblem problem(string_over_obstacle(32));
  problem.linear.rate = 0.99;
  problem.linear.max_iterations = 5;
  algebra::Vector X(problem.map());
  const NewtonReport report = newton(problem, X, {}, {}, 0);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.steps, 0);
  EXPECT_EQ(X.norm2(), 0);
  EXPECT_NE(report.why.find("linear solver"), std::string::npos) << report.why;
  EXPECT_NE(report.advice.find("linear/solver = direct"), std::string::npos) << report.advice;
}

TEST(Stopping, the_adaptive_rule_is_refused_without_an_estimate) {
  DenseProblem problem(string_over_obstacle(16));
  algebra::Vector X(problem.map());
  EXPECT_THROW(newton(problem, X, {}, rule(StoppingRule::adaptive), 10), core::InputError);
}

}  // namespace
}  // namespace thixis::complementarity::test
