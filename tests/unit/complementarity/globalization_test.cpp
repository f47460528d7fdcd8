#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dense_problem.hpp"
#include "thixis/complementarity/newton.hpp"

namespace thixis::complementarity::test {
namespace {

/// Ben Gharbia & Gilbert, Math. Program. 134 (2012), doi:10.1007/s10107-010-0439-6: a P-matrix of order 3 for which Newton-min cycles.
/// With q = (1, 1, 1) the solution is x = 0; where only x_i is free the system gives x_i = -1, and then, if alpha > 1, only x_{i+1} is
/// free.
DenseData cycling(double alpha) { return linear_complementarity({1, 0, alpha, alpha, 1, 0, 0, alpha, 1}, {1, 1, 1}); }
algebra::Vector first_free(const DenseProblem& problem) {
  return problem.vector([](int field, int point) { return field == 0 && point == 0 ? 1.0 : 0.0; });
}

struct Log {
  std::vector<NewtonRecord> records;
  std::vector<std::string> messages;
  NewtonObserver observer() {
    return {[this](const NewtonRecord& r) { records.push_back(r); }, {}, [this](const std::string& s) { messages.push_back(s); }};
  }
};

TEST(Globalization, the_example_really_cycles_with_period_three) {
  DenseProblem problem(cycling(2));
  algebra::Vector X = first_free(problem);
  NewtonParams params;
  params.max_iterations = 1;
  Values iterates[6];
  for (Values& iterate : iterates) {
    newton(problem, X, params, {}, 0);
    iterate = problem.gather(X);
  }
  EXPECT_EQ(iterates[0], iterates[3]);
  EXPECT_EQ(iterates[2], iterates[5]);
  EXPECT_NE(iterates[0], iterates[1]);
  EXPECT_NE(iterates[0], iterates[2]);
}

TEST(Globalization, a_cycle_is_found_said_and_left_by_damped_steps) {
  for (const Globalization globalization : {Globalization::none, Globalization::hybrid}) {
    DenseProblem problem(cycling(2));
    algebra::Vector X = first_free(problem);
    NewtonParams params;
    params.globalization = globalization;
    Log log;
    const NewtonReport report = newton(problem, X, params, {}, 0, log.observer());
    EXPECT_TRUE(report.converged) << report.why;
    EXPECT_GE(report.fallbacks, 1);
    ASSERT_FALSE(log.messages.empty());
    EXPECT_NE(log.messages[0].find("cycles with period 3"), std::string::npos) << log.messages[0];
    const Values solution = problem.gather(X);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(solution[2 * i], 0, 1e-8);
      EXPECT_NEAR(solution[2 * i + 1], 1, 1e-8);
    }
    EXPECT_EQ(static_cast<int>(log.records.size()), report.steps);
  }
}

TEST(Globalization, a_problem_without_solution_ends_unconverged) {  // x >= 0, -x - 1 >= 0
  DenseProblem problem(linear_complementarity({-1}, {-1}));
  algebra::Vector X(problem.map());
  NewtonParams params;
  params.max_iterations = 50;
  const NewtonReport report = newton(problem, X, params, {}, 0);
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(std::isfinite(X.norm2()));
}

TEST(Globalization, line_search_from_the_start_does_not_meet_the_cycle) {
  for (const CFunction function : {CFunction::min, CFunction::fischer_burmeister}) {
    DenseProblem problem(cycling(2));
    algebra::Vector X = first_free(problem);
    NewtonParams params;
    params.globalization = Globalization::line_search;
    params.c_function = function;
    const NewtonReport report = newton(problem, X, params, {}, 0);
    EXPECT_TRUE(report.converged) << report.why;
    EXPECT_EQ(report.fallbacks, 0);
  }
}

TEST(Globalization, damped_steps_lower_the_merit_function) {
  DenseProblem problem(string_over_obstacle(32));
  algebra::Vector X = problem.vector([](int field, int) { return field == 0 ? -3.0 : 500.0; });
  NewtonParams params;
  params.globalization = Globalization::line_search;
  params.c_function = CFunction::fischer_burmeister;
  const NewtonReport report = newton(problem, X, params, {}, 0);
  EXPECT_TRUE(report.converged) << report.why;
  for (std::size_t k = 1; k < report.residuals.size(); ++k) EXPECT_LT(report.residuals[k], report.residuals[k - 1]);
}

/// u³ - 2u + 2 = 0 far above its obstacle. From u = 0 full steps alternate between 0 and 1, and |R| has a minimum at u = √(2/3) that is no
/// solution.
TEST(Globalization, a_line_search_that_gets_stuck_says_so) {
  DenseData data = linear_complementarity({-2}, {2});
  data.cubic = 1;
  data.psi = {-10};
  for (const Globalization globalization : {Globalization::none, Globalization::line_search}) {
    DenseProblem problem(data);
    NewtonParams params;
    params.globalization = globalization;
    params.c_function = CFunction::fischer_burmeister;
    algebra::Vector X(problem.map());
    const NewtonReport report = newton(problem, X, params, {}, 0);
    EXPECT_FALSE(report.converged);
    if (globalization == Globalization::line_search) {
      EXPECT_NE(report.why.find("no step length lowers"), std::string::npos) << report.why;
      EXPECT_NE(report.advice.find("Try newton/c-function = min"), std::string::npos) << report.advice;
      EXPECT_NEAR(problem.gather(X)[0], std::sqrt(2.0 / 3), 1e-3);
    }
  }
}

/// Corrections three times too long: full steps double the error, steps of half the length halve it.
TEST(Globalization, hybrid_damps_when_the_residual_keeps_growing) {
  for (const CFunction function : {CFunction::min, CFunction::fischer_burmeister}) {
    NewtonParams params;
    params.c_function = function;
    DenseProblem full(string_over_obstacle(16)), damped(string_over_obstacle(16));
    full.linear.overshoot = damped.linear.overshoot = 3;
    algebra::Vector X(full.map()), Y(damped.map());
    EXPECT_FALSE(newton(full, X, params, {}, 0).converged);

    params.globalization = Globalization::hybrid;
    Log log;
    const NewtonReport report = newton(damped, Y, params, {}, 0, log.observer());
    EXPECT_TRUE(report.converged) << report.why;
    EXPECT_GE(report.fallbacks, 1);
    ASSERT_FALSE(log.messages.empty());
    EXPECT_NE(log.messages[0].find("keeps growing"), std::string::npos) << log.messages[0];
    const auto damped_step = [](const NewtonRecord& record) { return record.step_length < 1; };
    EXPECT_TRUE(std::any_of(log.records.begin(), log.records.end(), damped_step));
  }
}

TEST(Globalization, undamped_steps_that_diverge_end_long_before_their_numbers_do) {
  DenseProblem problem(string_over_obstacle(16));
  problem.linear.overshoot = 1e6;
  NewtonParams params;
  algebra::Vector X(problem.map());
  const NewtonReport report = newton(problem, X, params, {}, 0);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.why.find("diverges"), std::string::npos) << report.why;
  EXPECT_NE(report.advice.find("newton/globalization = hybrid"), std::string::npos) << report.advice;
  EXPECT_LE(report.steps, 5);
  EXPECT_LT(report.residuals.back(), 1e30 * report.residuals.front());

  X.putScalar(0);
  problem.linear.overshoot = 40;
  params.globalization = Globalization::hybrid;
  Log log;
  newton(problem, X, params, {}, 0, log.observer());
  ASSERT_FALSE(log.messages.empty());
  EXPECT_NE(log.messages[0].find("grown without bound"), std::string::npos) << log.messages[0];
}

TEST(Globalization, hybrid_goes_back_when_the_residual_is_not_finite) {
  DenseProblem problem(string_over_obstacle(16));
  problem.linear.overshoot = 40;
  problem.spoil = [](double row) { return std::abs(row) > 1 ? std::nan("") : row; };
  NewtonParams params;
  algebra::Vector X(problem.map());
  EXPECT_FALSE(newton(problem, X, params, {}, 0).converged);
  EXPECT_TRUE(std::isfinite(X.norm2()));

  X.putScalar(0);
  params.globalization = Globalization::hybrid;
  Log log;
  const NewtonReport report = newton(problem, X, params, {}, 0, log.observer());
  ASSERT_FALSE(log.messages.empty());
  EXPECT_NE(log.messages[0].find("not finite"), std::string::npos) << log.messages[0];
  EXPECT_GT(report.steps, 3);
  EXPECT_TRUE(std::isfinite(X.norm2()));
  EXPECT_LT(report.residuals.back(), report.residuals.front());
}

}  // namespace
}  // namespace thixis::complementarity::test
