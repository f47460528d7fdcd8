/// The estimate of two-phase flow: its parts vanish where they should, fall at the rates they should, and depend neither on units nor on
/// the number of ranks.
#include <gtest/gtest.h>

#include <cmath>

#include "flow_march.hpp"
#include "laws/settle.hpp"

namespace thixis::flow {
namespace {

using complementarity::Estimate;
using complementarity::Measure;
using complementarity::StoppingRule;

constexpr double length = 200;

/// The papers' injection on few cells, exact solvers.
std::unique_ptr<Flow> gas_injection(int cells, const core::Comm& comm, const TwoPhaseBoundParams& params = {}) {
  auto flow = std::make_unique<Flow>(interval(cells, length, comm), catalogued("gas injection short"), params);
  flow->stopping.nonlinear_tolerance = 1e-12;
  flow->stopping.linear_tolerance = 1e-13;
  return flow;
}

/// One Newton step from X: the system of Newton-min, solved to this tolerance.
Teuchos::RCP<algebra::Vector> newton_step(Flow& flow, const algebra::Vector& X, double tolerance) {
  complementarity::NewtonParams once = flow.newton;
  once.max_iterations = 1;
  complementarity::StoppingParams stopping;
  stopping.linear_tolerance = tolerance;
  const auto next = Teuchos::rcp(new algebra::Vector(X, Teuchos::Copy));
  complementarity::newton(flow.problem, *next, once, stopping, 0);
  return next;
}

void expect_non_negative(const Estimate& eta) {
  EXPECT_GE(eta.total, 0);
  EXPECT_GT(eta.discretization, 0);
  EXPECT_GE(eta.linearization, 0);
  EXPECT_GE(eta.algebraic, 0);
  EXPECT_LE(eta.total, (1 + 1e-12) * (eta.discretization + eta.linearization + eta.algebraic));
}

TEST(settle, keeps_pressure_and_hydrogen_and_obeys_the_contact_conditions) {
  for (const char* name : {"gas injection", "gas injection short"}) {
    const Settle settle{two_phase_laws(catalogued(name)), {}};
    const TwoPhaseLaws& laws = settle.laws;
    for (const double s_g : {-0.01, 0., 1e-7, 1e-4, 0.01, 0.05, 0.3})
      for (const double P : {3e5, 1e6, 2e6})
        for (const double chi : {-1e-6, 0., 5e-5, 1.2e-4, 1e-3}) {
          const PhaseState U = laws.state(s_g, P, chi), V = settle.settled(U);
          const double content = laws.masses(U).value[hydrogen];
          EXPECT_EQ(V.P, P);
          EXPECT_NEAR(laws.masses(V).value[hydrogen], content, 1e-10 * (std::abs(content) + 1e-3));
          EXPECT_GE(V.s_g, 0);
          EXPECT_GE(laws.undersaturation(V), -1e-12);
          EXPECT_NEAR(V.s_g * laws.undersaturation(V), 0, 1e-12);
          const PhaseState W = settle.settled(V);
          EXPECT_NEAR(W.s_g, V.s_g, 1e-11);
          EXPECT_NEAR(W.chi, V.chi, 1e-14);
        }
  }
}

TEST(two_phase_bound, linearization_and_algebraic_part_vanish_at_convergence) {
  for (const Measure measure : {Measure::residual, Measure::literature}) {
    TwoPhaseBoundParams params;
    params.measure = measure;
    const auto flow = gas_injection(100, core::Comm(), params);
    for (int n = 0; n < 8; ++n) {
      ASSERT_TRUE(flow->step(5000).converged);
      const Estimate eta = flow->estimate(*flow->X);
      expect_non_negative(eta);
      EXPECT_LE(eta.linearization, 1e-7 * eta.discretization) << "step " << n + 1;
      EXPECT_LE(eta.algebraic, 1e-7 * eta.discretization) << "step " << n + 1;
    }
  }
}

/// A solved linear system has no algebraic part, but its solution misses the nonlinear equations; one that is not solved has both.
TEST(two_phase_bound, tells_the_linear_solver_from_linearization) {
  const auto flow = gas_injection(100, core::Comm());
  for (int n = 0; n < 6; ++n) flow->step(5000);
  flow->begin(5000);
  const auto X = newton_step(*flow, *flow->X, 1e-14);
  const Estimate solved = flow->estimate(*X);
  expect_non_negative(solved);
  EXPECT_LE(solved.algebraic, 1e-9 * solved.discretization);
  EXPECT_GT(solved.linearization, 1e-2 * solved.discretization);
  EXPECT_TRUE(solved.evident);

  const auto half = Teuchos::rcp(new algebra::Vector(*X, Teuchos::Copy));
  half->update(0.5, *flow->X, 0.5);
  EXPECT_GT(flow->estimate(*half).algebraic, 0.1 * solved.discretization);
  // At the point of linearization the linear residual is the nonlinear one.
  const Estimate start = flow->estimate(*flow->X);
  EXPECT_LE(start.linearization, 1e-6 * start.algebraic);
}

/// The part that is the residual of an interval is its dual norm: the integral of the squared sum from the closed end.
TEST(two_phase_bound, is_the_dual_norm_of_the_residual_on_an_interval) {
  const core::Comm self(MPI_COMM_SELF);
  const auto flow = gas_injection(50, self);
  for (int n = 0; n < 6; ++n) flow->step(5000);
  flow->begin(5000);
  algebra::Vector R(flow->flow.map());
  const auto X = Teuchos::rcp(new algebra::Vector(*flow->X, Teuchos::Copy));
  {  // settled states with a residual: pressures moved
    const auto x = algebra::host_view(*X);
    for (LocalIndex K = 0; K < 50; ++K) x(3 * K + pressure) += 3e3 * std::sin(0.2 * K);
  }
  const auto settled = predicted(flow->flow, *X, *X, 0);
  flow->problem.equations(*settled, R);
  const auto r = algebra::host_view(std::as_const(R));
  const double h = length / 50, tau = 5000 * year, alpha = 2500 * year;
  double square = 0;
  for (int c = 0; c < components; ++c) {
    double sum = 0;
    for (LocalIndex K = 0; K < 50; ++K) {
      const double before = sum;
      sum += h * r(3 * K + 1 + c) / tau;
      square += h / 3 * (before * before + before * sum + sum * sum);
    }
  }
  const double expected = std::sqrt(tau * alpha / (length * length * length) * square);
  const Estimate eta = flow->bound(*settled, {});
  EXPECT_NEAR(eta.linearization, expected, 1e-8 * expected);
  EXPECT_EQ(eta.algebraic, 0);
}

TEST(two_phase_bound, does_not_depend_on_the_unit_of_time) {
  // Everything that has the unit of time in it, in seconds.
  TwoPhaseScene in_seconds = catalogued("gas injection short");
  const TwoPhaseScene in_years = in_seconds;
  in_seconds.boundary["left"].hydrogen = scene::constant(5.57e-6 / year);
  const core::Comm comm;
  Flow years(interval(60, length, comm), in_years), seconds(interval(60, length, comm), in_seconds, {}, 1);
  for (int n = 0; n < 5; ++n) {
    years.step(5000);
    seconds.step(5000 * year);
  }
  years.begin(5000);
  seconds.begin(5000 * year);
  const auto X = newton_step(years, *years.X, 1e-12), Y = newton_step(seconds, *seconds.X, 1e-12);
  const Estimate a = years.estimate(*X), b = seconds.estimate(*Y);
  EXPECT_NEAR(a.discretization, b.discretization, 1e-6 * a.discretization);
  EXPECT_NEAR(a.linearization, b.linearization, 1e-5 * a.linearization);
  EXPECT_NEAR(a.total, b.total, 1e-6 * a.total);
}

TEST(two_phase_bound, counts_in_units_of_the_time_scale) {
  TwoPhaseBoundParams four;
  four.time_scale *= 4;
  const auto one = gas_injection(60, core::Comm()), other = gas_injection(60, core::Comm(), four);
  for (int n = 0; n < 5; ++n) {
    one->step(5000);
    other->step(5000);
  }
  one->begin(5000);
  other->begin(5000);
  const Estimate a = one->estimate(*one->X), b = other->estimate(*other->X);
  EXPECT_NEAR(b.linearization, 2 * a.linearization, 1e-6 * a.linearization);
}

TEST(two_phase_bound, is_the_same_on_any_number_of_ranks) {
  const auto whole = gas_injection(60, core::Comm(MPI_COMM_SELF)), shared = gas_injection(60, core::Comm());
  for (int n = 0; n < 7; ++n) {
    whole->step(5000);
    shared->step(5000);
  }
  whole->begin(5000);
  shared->begin(5000);
  const Estimate a = whole->estimate(*newton_step(*whole, *whole->X, 1e-13)),
                 b = shared->estimate(*newton_step(*shared, *shared->X, 1e-13));
  EXPECT_NEAR(a.total, b.total, 1e-6 * a.total);
  EXPECT_NEAR(a.discretization, b.discretization, 1e-6 * a.discretization);
  EXPECT_NEAR(a.linearization, b.linearization, 1e-6 * a.linearization);
}

TEST(two_phase_bound, is_the_same_on_any_number_of_ranks_in_two_dimensions) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::tensor;
  params.cells = {24, 6};
  params.lower = {0, 0};
  params.upper = {200, 20};
  Estimate eta[2];
  for (const bool shared : {false, true}) {
    const core::Comm comm(shared ? MPI_COMM_WORLD : MPI_COMM_SELF);
    Flow flow(fv::build(params, comm, "."), catalogued("gas injection 2d"));
    flow.stopping.linear_tolerance = 1e-13;
    flow.stopping.nonlinear_tolerance = 1e-11;
    for (int n = 0; n < 4; ++n) flow.step(5000);
    flow.begin(5000);
    eta[shared] = flow.estimate(*newton_step(flow, *flow.X, 1e-13));
    expect_non_negative(eta[shared]);
  }
  EXPECT_NEAR(eta[0].total, eta[1].total, 1e-6 * eta[0].total);
  EXPECT_NEAR(eta[0].discretization, eta[1].discretization, 1e-6 * eta[0].discretization);
  EXPECT_NEAR(eta[0].linearization, eta[1].linearization, 1e-5 * eta[0].linearization);
}

/// Where gas comes in the step, and nowhere else.
TEST(two_phase_bound, lights_up_at_the_front) {
  const core::Comm self(MPI_COMM_SELF);
  const auto flow = gas_injection(100, self);
  for (int n = 0; n < 10; ++n) flow->step(5000);
  const double behind = flow->front();
  flow->step(5000);
  const double front = flow->front();
  flow->estimate(*flow->X);
  const auto where = flow->bound.cells().phase_transition;
  for (LocalIndex K = 0; K < 100; ++K) {
    const double x = flow->flow.grid().centre(K, 0);
    if (x > behind && x < front) EXPECT_GT(where(K), 1e-7) << x;
    else EXPECT_LE(where(K), 1e-10) << x;
  }
}

/// Hydrogen that stays dissolved and water that is pressed through: both parts of order 1.
TwoPhaseScene smooth_flow() {
  TwoPhaseScene scene = catalogued("gas injection");
  const double pi = std::acos(-1.0);
  scene.initial.chi = scene::formula([=](double x, double) { return 2e-5 * (1 - std::cos(pi * x / 100)); });
  scene.boundary["left"].kind = FlowBoundaryKind::state;
  scene.boundary["left"].state = {scene::constant(0), scene::constant(1.4e6), scene::constant(0)};
  return scene;
}

TEST(two_phase_bound, error_in_space_is_of_order_one) {
  std::vector<double> space;
  for (const int cells : {50, 100, 200}) {
    Flow flow(interval(cells, length, core::Comm()), smooth_flow());
    for (int n = 0; n < 3; ++n) {
      flow.step(20000);
      flow.estimate(*flow.X);
    }
    space.push_back(flow.bound.step_errors().space);
  }
  EXPECT_GT(std::log2(space[0] / space[1]), 0.85);
  EXPECT_GT(std::log2(space[1] / space[2]), 0.9);
}

TEST(two_phase_bound, error_in_time_is_of_order_one) {
  std::vector<double> time;
  for (const int steps : {8, 16, 32}) {
    Flow flow(interval(50, length, core::Comm()), smooth_flow());
    double sum = 0;
    for (int n = 0; n < steps; ++n) {
      flow.step(4e5 / steps);
      flow.estimate(*flow.X);
      if (n >= steps / 4) sum += std::pow(flow.bound.step_errors().time, 2);  // behind the start, where the pressure is not smooth in time
    }
    time.push_back(std::sqrt(sum));
  }
  EXPECT_GT(std::log2(time[0] / time[1]), 0.8);
  EXPECT_GT(std::log2(time[1] / time[2]), 0.9);
}

/// At rest under gravity nothing is wrong.
TEST(two_phase_bound, vanishes_at_hydrostatic_rest) {
  TwoPhaseScene scene = catalogued("gas injection 2d");
  scene.boundary.erase("left");
  mesh::MeshParams params;
  params.generator = mesh::Generator::tensor;
  params.cells = {8, 5};
  params.lower = {0, 0};
  params.upper = {200, 20};
  const core::Comm comm;
  Flow flow(fv::build(params, comm, "."), scene);
  flow.step(5000);
  const Estimate eta = flow.estimate(*flow.X);
  EXPECT_LE(eta.total, 1e-9);
}

/// The rule takes one or two steps for each of the time, and the gas is where the exact rule has it.
TEST(two_phase_bound, stops_newton_early_and_leaves_the_front_in_place) {
  const auto exact = gas_injection(200, core::Comm()), adaptive = gas_injection(200, core::Comm());
  adaptive->stopping = {};
  adaptive->stopping.rule = StoppingRule::adaptive;
  adaptive->predict = true;
  int exact_steps = 0, adaptive_steps = 0;
  for (int n = 0; n < 30; ++n) {
    exact_steps += exact->step(5000).steps;
    const auto report = adaptive->step(5000);
    ASSERT_TRUE(report.converged);
    adaptive_steps += report.steps;
    EXPECT_LE(std::abs(adaptive->front() - exact->front()), 1.0 + 1e-9) << "step " << n + 1;  // one cell
  }
  EXPECT_LE(2 * adaptive_steps, exact_steps);
}

}  // namespace
}  // namespace thixis::flow
