#include "thixis/complementarity/newton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dense_problem.hpp"
#include "thixis/core/error.hpp"

namespace thixis::complementarity::test {
namespace {

const std::vector<CFunction> both = {CFunction::min, CFunction::fischer_burmeister};

double error(const DenseProblem& problem, const algebra::Vector& X, const std::function<double(int, int)>& exact) {
  algebra::Vector difference = problem.vector(exact);
  difference.update(-1, X, 1);
  return difference.normInf();
}

/// From X = 0, to tight tolerances.
struct Solved {
  explicit Solved(DenseProblem& problem, const NewtonParams& params = {}, const StoppingParams& stopping = {})
      : X(problem.map()), report(newton(problem, X, params, stopping, 0, observer())) {}
  NewtonObserver observer() {
    return {[this](const NewtonRecord& record) { records.push_back(record); }, {}, [this](const std::string& s) { messages.push_back(s); }};
  }
  std::vector<NewtonRecord> records;
  std::vector<std::string> messages;
  algebra::Vector X;
  NewtonReport report;
};

TEST(Newton, finds_the_string_over_the_obstacle_with_either_function_ties_and_scaling) {
  for (const CFunction function : both)
    for (const Ties ties : {Ties::contact, Ties::free})
      for (const Scaling scaling : {Scaling::none, Scaling::physical}) {
        DenseProblem problem(string_over_obstacle(32));
        NewtonParams params;
        params.c_function = function, params.ties = ties, params.scaling = scaling;
        const Solved solved(problem, params);
        EXPECT_TRUE(solved.report.converged) << solved.report.why;
        EXPECT_LT(error(problem, solved.X, [](int f, int i) { return string_solution(32, f, i); }), 1e-7);
        EXPECT_GE(solved.report.active, 15);
        EXPECT_LE(solved.report.active, 17);
      }
}

TEST(Newton, finds_two_strings_with_different_tensions) {
  for (const CFunction function : both) {
    DenseProblem problem(two_strings(24));
    NewtonParams params;
    params.c_function = function;
    const Solved solved(problem, params);
    EXPECT_TRUE(solved.report.converged) << solved.report.why;
    EXPECT_LT(error(problem, solved.X, [](int f, int i) { return two_strings_solution(24, f, i); }), 1e-7);
  }
}

TEST(Newton, converges_quadratically_to_a_solution_of_a_nonlinear_equation) {
  for (const CFunction function : both) {
    DenseData data = string_over_obstacle(16);
    data.cubic = 2;
    // Manufactured: the string's solution gets the force that its cubic reaction takes away.
    for (int i = 0; i < data.n; ++i) data.F[0][i] += data.cubic * std::pow(string_solution(16, 0, i), 3);
    DenseProblem problem(data);
    NewtonParams params;
    params.c_function = function;
    StoppingParams stopping;
    stopping.nonlinear_tolerance = stopping.linear_tolerance = 1e-12;
    const Solved solved(problem, params, stopping);
    EXPECT_TRUE(solved.report.converged) << solved.report.why;
    EXPECT_LT(error(problem, solved.X, [](int f, int i) { return string_solution(16, f, i); }), 1e-10);
  }
}

/// An unchanged contact set alone must not end the run: the equation is not solved yet.
TEST(Newton, does_not_take_an_unchanged_contact_set_for_convergence_if_the_equation_is_nonlinear) {
  DenseData data = string_over_obstacle(16);
  data.cubic = 50;
  data.psi.assign(data.n, -10);  // never touched
  DenseProblem problem(data);
  StoppingParams stopping;
  stopping.nonlinear_tolerance = 1e-12;
  NewtonParams params;
  params.scaling = Scaling::physical;
  const Solved solved(problem, params, stopping);
  EXPECT_TRUE(solved.report.converged);
  int unchanged = 0;
  for (const NewtonRecord& record : solved.records) unchanged += record.changed == 0;
  EXPECT_GE(unchanged, 3);
  algebra::Vector R(problem.map());
  problem.equations(solved.X, R);
  EXPECT_LT(R.norm2(), 1e-10 * problem.reference_norm());
}

TEST(Newton, min_stops_at_the_first_unchanged_contact_set_whatever_the_residual_tolerance) {
  DenseProblem problem(string_over_obstacle(32));
  StoppingParams stopping;
  stopping.nonlinear_tolerance = 1e-300;
  const Solved solved(problem, {}, stopping);
  EXPECT_TRUE(solved.report.converged);
  EXPECT_NE(solved.report.why.find("contact set did not change"), std::string::npos) << solved.report.why;
  EXPECT_EQ(solved.records.back().changed, 0);
  for (std::size_t k = 1; k + 1 < solved.records.size(); ++k) EXPECT_GT(solved.records[k].changed, 0);
}

TEST(Newton, ends_at_once_when_it_starts_from_the_solution) {
  DenseProblem problem(string_over_obstacle(16));
  algebra::Vector X = problem.vector([](int f, int i) { return string_solution(16, f, i); });
  const NewtonReport report = newton(problem, X, {}, {}, 0);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.steps, 0);
  EXPECT_EQ(report.residuals.size(), 1u);
}

TEST(Newton, goes_from_a_cold_start_through_residuals_that_are_not_monotone) {
  DenseProblem problem(string_over_obstacle(64));
  NewtonParams params;
  params.scaling = Scaling::none;
  const Solved solved(problem, params);
  EXPECT_TRUE(solved.report.converged);
  bool grown = false;
  for (std::size_t k = 1; k < solved.report.residuals.size(); ++k)
    grown = grown || solved.report.residuals[k] > solved.report.residuals[k - 1];
  EXPECT_TRUE(grown);
  EXPECT_EQ(solved.report.fallbacks, 0);
}

/// The start has a positive gap and a positive multiplier, so that the comparison of the two decides where contact begins: on half of the
/// string in physical scaling.
TEST(Newton, physical_scaling_makes_the_contact_sets_independent_of_the_units) {
  const auto sets = [](double length, double tension, Scaling scaling) {
    DenseProblem problem(string_over_obstacle(64, length, tension));
    algebra::Vector X = problem.vector([&](int field, int i) {
      const double x = (i + 1) / 64.0;
      return field == 0 ? length * (-0.25 + 1e-3 * x) : length * tension * 8.192 * (1 - x);
    });
    NewtonParams params;
    params.scaling = scaling;
    std::vector<long long> active;
    NewtonObserver observer;
    observer.step = [&](const NewtonRecord& record) { active.insert(active.end(), {record.active, record.changed}); };
    const NewtonReport report = newton(problem, X, params, {}, 0, observer);
    EXPECT_TRUE(report.converged) << report.why;
    active.push_back(static_cast<long long>(report.active_set.fingerprint()));
    return active;
  };
  // Powers of 2: the same digits in all units.
  const std::vector<long long> reference = sets(1, 1, Scaling::physical);
  EXPECT_EQ(reference, sets(1024, 1, Scaling::physical));
  EXPECT_EQ(reference, sets(1.0 / 65536, 4096, Scaling::physical));
  EXPECT_EQ(reference, sets(1, 1.0 / 65536, Scaling::physical));
  EXPECT_NE(sets(1, 1, Scaling::none), sets(1, 1.0 / 65536, Scaling::none));
}

TEST(Newton, reports_each_step_to_the_observer) {
  DenseProblem problem(string_over_obstacle(32));
  const Solved solved(problem);
  ASSERT_EQ(static_cast<int>(solved.records.size()), solved.report.steps);
  ASSERT_EQ(static_cast<int>(solved.report.residuals.size()), solved.report.steps + 1);
  int linear = 0;
  for (int k = 0; k < solved.report.steps; ++k) {
    const NewtonRecord& record = solved.records[k];
    EXPECT_EQ(record.step, k + 1);
    EXPECT_EQ(record.residual, solved.report.residuals[k + 1]);
    EXPECT_NEAR(record.residual, std::hypot(record.residual_equations, record.residual_complementarity), 1e-12 * (1 + record.residual));
    EXPECT_EQ(record.step_length, 1);
    EXPECT_GE(record.seconds, 0);
    linear += record.linear_iterations;
  }
  EXPECT_EQ(linear, solved.report.linear_iterations);
  EXPECT_EQ(solved.records.back().active, solved.report.active);
}

TEST(Newton, ends_unconverged_at_its_limit_and_keeps_the_last_iterate) {
  DenseProblem problem(string_over_obstacle(64));
  NewtonParams params;
  params.max_iterations = 2;
  const Solved solved(problem, params);
  EXPECT_FALSE(solved.report.converged);
  EXPECT_EQ(solved.report.steps, 2);
  EXPECT_NE(solved.report.why.find("max iterations"), std::string::npos) << solved.report.why;
  EXPECT_NE(solved.report.advice.find("Try more newton/max iterations"), std::string::npos) << solved.report.advice;

  DenseProblem again(string_over_obstacle(64));
  algebra::Vector X(again.map());
  params.max_iterations = 1;
  newton(again, X, params, {}, 0);
  newton(again, X, params, {}, 0);
  X.update(-1, solved.X, 1);
  EXPECT_LT(X.normInf(), 1e-12);
}

TEST(Newton, with_no_iterations_evaluates_nothing) {
  DenseProblem problem(string_over_obstacle(16));
  NewtonParams params;
  params.max_iterations = 0;
  const Solved solved(problem, params);
  EXPECT_FALSE(solved.report.converged);
  EXPECT_EQ(solved.report.steps, 0);
  EXPECT_EQ(problem.equations_asked, 0);
  EXPECT_TRUE(problem.tolerances.empty());
}

TEST(Newton, reports_nan_of_the_problem_and_keeps_the_iterate_before_it) {
  for (const CFunction function : both) {
    DenseProblem problem(string_over_obstacle(16));
    problem.spoil = [&](double row) { return problem.equations_asked > 2 ? std::numeric_limits<double>::quiet_NaN() : row; };
    NewtonParams params;
    params.c_function = function;
    const Solved solved(problem, params);
    EXPECT_FALSE(solved.report.converged);
    EXPECT_EQ(solved.report.steps, 2);
    EXPECT_NE(solved.report.why.find("not a finite number"), std::string::npos) << solved.report.why;
    EXPECT_NE(solved.report.advice.find("newton/globalization = hybrid"), std::string::npos) << solved.report.advice;
    EXPECT_TRUE(std::isfinite(solved.X.norm2()));
  }
}

TEST(Newton, reports_nan_at_the_start) {
  DenseProblem problem(string_over_obstacle(16));
  problem.spoil = [](double) { return std::numeric_limits<double>::quiet_NaN(); };
  const Solved solved(problem);
  EXPECT_FALSE(solved.report.converged);
  EXPECT_EQ(solved.report.steps, 0);
  EXPECT_NE(solved.report.why.find("not a finite number"), std::string::npos) << solved.report.why;
  EXPECT_NE(solved.report.advice.find("newton/initial"), std::string::npos) << solved.report.advice;
}

TEST(Newton, reports_nan_of_the_linear_solver_and_keeps_the_start) {
  DenseProblem problem(string_over_obstacle(16));
  problem.linear.gives_nan = true;
  const Solved solved(problem);
  EXPECT_FALSE(solved.report.converged);
  EXPECT_EQ(solved.report.steps, 0);
  EXPECT_EQ(solved.X.norm2(), 0);
  EXPECT_NE(solved.report.why.find("not finite"), std::string::npos) << solved.report.why;
  EXPECT_NE(solved.report.advice.find("linear/solver = direct"), std::string::npos) << solved.report.advice;

  problem.linear.reason = "the factorization has a zero pivot";
  const Solved told(problem);
  EXPECT_NE(told.report.why.find("the linear solver found nothing: the factorization has a zero pivot"), std::string::npos)
      << told.report.why;
}

TEST(Newton, refuses_a_scaling_that_is_not_positive) {
  DenseData data = string_over_obstacle(16);
  data.scaling[3] = 0;
  DenseProblem problem(data);
  algebra::Vector X(problem.map());
  EXPECT_THROW(newton(problem, X, {}, {}, 0), core::Error);
}

}  // namespace
}  // namespace thixis::complementarity::test
