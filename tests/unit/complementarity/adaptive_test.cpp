#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dense_problem.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::complementarity::test {
namespace {

double negative_part(double x) { return std::max(-x, 0.0); }

/// Of a string over an obstacle: what is below it or pulled down belongs to the linearization, what is out of balance to the linear solver.
/// The mesh is taken to leave an error of `discretization`.
struct Eta {
  const DenseProblem& problem;
  double discretization;
  mutable int calls = 0;

  Estimate operator()(const algebra::Vector& X) const {
    ++calls;
    algebra::Vector R(X.getMap());
    problem.equations(X, R);
    const Values x = problem.gather(X);
    Estimate eta;
    eta.discretization = discretization;
    eta.algebraic = R.norm2();
    for (std::size_t i = 0; i + 1 < x.size(); i += 2)
      eta.linearization += negative_part(x[i] + 0.25) + problem.data().D[0] * negative_part(x[i + 1]);
    eta.total = eta.discretization + eta.linearization + eta.algebraic;
    eta.worst_algebraic = 2 * eta.algebraic / std::max(eta.discretization, eta.linearization);
    eta.worst_linearization = 2 * eta.linearization / eta.discretization;
    return eta;
  }
};

/// A cold start of a string over an obstacle, with a linear solver that gains a digit in ten iterations.
struct Solved {
  explicit Solved(const StoppingParams& stopping, const NewtonParams& params = {}, int check_every = 3) : X(problem.map()) {
    problem.linear.rate = 0.8;
    NewtonObserver observer;
    observer.step = [this](const NewtonRecord& record) { steps.push_back(record); };
    observer.linear = [this](const LinearRecord& record) { looks.push_back(record); };
    report = newton(problem, X, params, stopping, check_every, observer, std::cref(eta));
  }
  DenseProblem problem{string_over_obstacle(64)};
  Eta eta{problem, 1e-3};
  algebra::Vector X;
  NewtonReport report;
  std::vector<NewtonRecord> steps;
  std::vector<LinearRecord> looks;
};

StoppingParams adaptive() {
  StoppingParams stopping;
  stopping.rule = StoppingRule::adaptive;
  return stopping;
}

bool algebraic_small(const Estimate& eta, const StoppingParams& stopping) {
  return eta.algebraic <= stopping.gamma_algebraic * std::max(eta.discretization, eta.linearization);
}
bool small(const Estimate& eta, const StoppingParams& stopping) {
  return algebraic_small(eta, stopping) && eta.linearization <= stopping.gamma_linearization * eta.discretization;
}

TEST(Adaptive, takes_fewer_linear_iterations_than_the_exact_rule) {
  const Solved exact({}), saving(adaptive());
  EXPECT_TRUE(exact.report.converged) << exact.report.why;
  EXPECT_TRUE(saving.report.converged) << saving.report.why;
  EXPECT_LT(2 * saving.report.linear_iterations, exact.report.linear_iterations);
}

TEST(Adaptive, ends_where_its_criterion_holds_and_says_so) {
  const Solved solved(adaptive());
  ASSERT_TRUE(solved.report.estimate);
  EXPECT_TRUE(small(*solved.report.estimate, adaptive()));
  EXPECT_NE(solved.report.why.find("do not count beside the discretization error 1.00e-03"), std::string::npos) << solved.report.why;
  for (std::size_t k = 1; k + 1 < solved.steps.size(); ++k)
    EXPECT_FALSE(small(*solved.steps[k].estimate, adaptive()) && small(*solved.steps[k - 1].estimate, adaptive()));
}

TEST(Adaptive, leaves_each_linear_system_at_the_first_look_where_the_algebraic_error_is_small) {
  const Solved solved(adaptive());
  for (std::size_t i = 0; i < solved.looks.size(); ++i) {
    if (!solved.looks[i].estimate) continue;
    const int step = solved.looks[i].step;
    if (step > 2 && solved.steps[step - 2].changed == 0) continue;  // Newton did not get ahead: the rule is stricter
    const bool last = i + 1 == solved.looks.size() || solved.looks[i + 1].step > step;
    EXPECT_EQ(last, algebraic_small(*solved.looks[i].estimate, adaptive())) << "step " << step;
  }
}

TEST(Adaptive, asks_every_so_many_iterations_and_never_twice_at_one_iterate) {
  for (const bool all : {true, false})
    for (const int every : {1, 2, 5}) {
      StoppingParams stopping = adaptive();
      if (all) stopping.estimate = true;
      const Solved solved(stopping, {}, every);
      int asked = 0, reused = 0;
      for (const LinearRecord& look : solved.looks) {
        EXPECT_EQ(look.iteration % every, 0);
        if (all && look.iteration > 0) {
          EXPECT_TRUE(look.estimate);
        }
        asked += look.estimate.has_value();
        reused += look.estimate && look.iteration == solved.steps[look.step - 1].linear_iterations;
      }
      EXPECT_GT(reused, 0);
      EXPECT_EQ(solved.eta.calls, asked + solved.report.steps - reused);
    }
}

/// Where the algebraic error exceeds what is allowed by far, looks pass without an estimate until the residual has fallen accordingly.
TEST(Adaptive, asks_no_estimate_while_the_residual_says_that_it_is_too_early) {
  const Solved solved(adaptive(), {}, 1);
  int passed = 0;
  for (std::size_t i = 1; i < solved.looks.size(); ++i) passed += solved.looks[i].iteration > 0 && !solved.looks[i].estimate;
  EXPECT_GT(passed, 0);
  StoppingParams every_look = adaptive();
  every_look.estimate = true;
  EXPECT_LE(solved.report.linear_iterations, 2 * Solved(every_look, {}, 1).report.linear_iterations);
}

TEST(Adaptive, the_estimate_of_a_step_is_the_one_at_its_iterate_also_in_damped_steps) {
  NewtonParams damped;
  damped.globalization = Globalization::line_search;
  damped.c_function = CFunction::fischer_burmeister;
  DenseProblem problem(string_over_obstacle(64));
  problem.linear.rate = 0.5;
  problem.linear.overshoot = 3;
  std::vector<double> of_steps, of_iterates, lengths;
  NewtonObserver observer;
  observer.step = [&](const NewtonRecord& record) { of_steps.push_back(record.estimate->total), lengths.push_back(record.step_length); };
  observer.iterate = [&](const algebra::Vector& X) { of_iterates.push_back(X.norm2()); };
  StoppingParams stopping = adaptive();
  algebra::Vector X(problem.map());
  newton(problem, X, damped, stopping, 1, observer, [](const algebra::Vector& at) { return Estimate{at.norm2(), 0, 1, 0, 0, 0}; });
  EXPECT_EQ(of_steps, of_iterates);
  EXPECT_LT(*std::min_element(lengths.begin(), lengths.end()), 1);
}

/// A problem whose smoothing moves the iterate.
class Smoothed : public DenseProblem {
 public:
  using DenseProblem::DenseProblem;
  void relax(algebra::Vector& X, int) const override { X.scale(1 + 1e-3); }
};

TEST(Adaptive, the_estimate_of_a_step_is_the_one_behind_the_smoothing) {
  Smoothed problem(string_over_obstacle(32));
  problem.linear.rate = 0.5;
  NewtonParams params;
  params.sweeps = 1, params.max_iterations = 4;
  std::vector<double> of_steps, of_iterates;
  NewtonObserver observer;
  observer.step = [&](const NewtonRecord& record) { of_steps.push_back(record.estimate->total); };
  observer.iterate = [&](const algebra::Vector& X) { of_iterates.push_back(X.norm2()); };
  algebra::Vector X(problem.map());
  newton(problem, X, params, adaptive(), 1, observer, [](const algebra::Vector& at) { return Estimate{at.norm2(), 0, 1, 0, 0, 0}; });
  ASSERT_FALSE(of_steps.empty());
  EXPECT_EQ(of_steps, of_iterates);
}

/// eta_lin by step; the linear solver is exact.
NewtonReport with_linearization_errors(const std::vector<double>& eta_lin, DenseData data = string_over_obstacle(64)) {
  DenseProblem problem(std::move(data));
  algebra::Vector X(problem.map());
  std::size_t calls = 0;
  return newton(problem, X, {}, adaptive(), 10, {},
                [&](const algebra::Vector&) { return Estimate{1, 1, eta_lin[std::min(calls++, eta_lin.size() - 1)], 0, 0, 0}; });
}

TEST(Adaptive, one_small_linearization_error_is_no_evidence) {
  EXPECT_GT(with_linearization_errors({0.01, 5, 5, 5, 0.01, 5, 0.2}).steps, 6);
  EXPECT_GT(with_linearization_errors({5, 0.01, 5, 5}).steps, 3);
}

TEST(Adaptive, the_evidence_costs_one_step) {
  EXPECT_EQ(with_linearization_errors({0.01}).steps, 2);
  EXPECT_EQ(with_linearization_errors({5, 5, 0.2, 0.1}).steps, 4);
}

TEST(Adaptive, a_settled_contact_set_is_evidence_enough) {
  DenseData untouched = string_over_obstacle(64);
  untouched.psi.assign(untouched.n, -10);
  untouched.cubic = 50;  // many steps to a small residual
  DenseProblem problem(untouched);
  algebra::Vector X = problem.vector([](int field, int) { return field == 0 ? 0.0 : -1e-3; });
  int calls = 0;
  const NewtonReport report =
      newton(problem, X, {}, adaptive(), 10, {}, [&](const algebra::Vector&) { return Estimate{1, 1, ++calls < 2 ? 5.0 : 0.1, 0, 0, 0}; });
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.steps, 2) << report.why;
}

TEST(Adaptive, the_local_rule_looks_at_the_worst_cell) {
  StoppingParams local = adaptive();
  local.local = true;
  const Solved everywhere(local), as_a_whole(adaptive());
  ASSERT_TRUE(everywhere.report.estimate);
  EXPECT_LE(everywhere.report.estimate->worst_algebraic, local.gamma_algebraic);
  EXPECT_LE(everywhere.report.estimate->worst_linearization, local.gamma_linearization);
  EXPECT_GT(everywhere.report.linear_iterations, as_a_whole.report.linear_iterations);
}

TEST(Adaptive, a_criterion_out_of_reach_leaves_the_exact_rule) {
  const auto hopeless = [](const algebra::Vector&) { return Estimate{3, 1, 1, 1, 9, 9}; };
  DenseProblem problem(string_over_obstacle(32)), exact(string_over_obstacle(32));
  problem.linear.rate = exact.linear.rate = 0.5;
  algebra::Vector X(problem.map()), Y(exact.map());
  const NewtonReport report = newton(problem, X, {}, adaptive(), 2, {}, hopeless), same = newton(exact, Y, {}, {}, 2);
  EXPECT_TRUE(report.converged) << report.why;
  EXPECT_EQ(report.steps, same.steps);
  EXPECT_EQ(report.linear_iterations, same.linear_iterations);
}

TEST(Adaptive, where_newton_stands_still_linear_systems_are_solved_better) {
  const auto stands = [](const algebra::Vector&) {
    return Estimate{12, 1, 10, 0.5, 0, 0};
  };  // gamma_alg eta_lin = 3, gamma_alg eta_disc = 0.3
  DenseProblem problem(string_over_obstacle(32));
  problem.linear.rate = 0.9;
  std::vector<int> iterations;
  NewtonObserver observer;
  observer.step = [&](const NewtonRecord& record) { iterations.push_back(record.linear_iterations); };
  algebra::Vector X(problem.map());
  const NewtonReport report = newton(problem, X, {}, adaptive(), 1, observer, stands);
  EXPECT_TRUE(report.converged) << report.why;
  EXPECT_EQ(iterations.front(), 1);
  EXPECT_GT(*std::max_element(iterations.begin(), iterations.end()), 20);
  EXPECT_LE(iterations.size(), 40u);
}

TEST(Adaptive, other_rules_ask_for_no_estimate_unless_the_user_does) {
  for (const StoppingRule rule : {StoppingRule::exact, StoppingRule::inexact}) {
    StoppingParams stopping;
    stopping.rule = rule;
    const Solved silent(stopping);
    EXPECT_EQ(silent.eta.calls, 0);
    EXPECT_FALSE(silent.report.estimate);
    stopping.estimate = true;
    const Solved curious(stopping);
    EXPECT_EQ(curious.report.linear_iterations, silent.report.linear_iterations);
    EXPECT_EQ(curious.report.steps, silent.report.steps);
    EXPECT_TRUE(curious.report.estimate);
    for (const NewtonRecord& step : curious.steps) EXPECT_TRUE(step.estimate);
    for (const LinearRecord& look : curious.looks) EXPECT_EQ(look.estimate.has_value(), look.iteration > 0);
  }
}

TEST(Adaptive, the_time_of_the_estimator_has_a_name) {
  core::reset_regions();
  const Solved solved(adaptive());
  int calls = 0;
  for (const core::RegionTime& region : core::regions()) calls += region.name == "estimate" ? region.calls : 0;
  EXPECT_EQ(calls, solved.eta.calls);
  EXPECT_GT(core::seconds("estimate"), 0);
}

}  // namespace
}  // namespace thixis::complementarity::test
