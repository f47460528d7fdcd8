/// The number of semismooth Newton steps against counts computed independently (scaling s = 1, as there).
#include <gtest/gtest.h>

#include "iterates.hpp"

namespace thixis::verification {
namespace {

int steps(int level, complementarity::Ties ties) {
  auto params = catalogued("smooth contact", level);
  params.newton.start = complementarity::Start::cold;
  params.newton.scaling = complementarity::Scaling::none;
  params.newton.ties = ties;
  const Solved run = solve(params);
  EXPECT_TRUE(run.outcome.solved) << run.outcome.finest.why;
  return run.outcome.at.newton_iterations;
}

}  // namespace

TEST(NewtonSteps, a_cold_start_with_ties_in_contact_takes_twice_as_many_on_each_level) {
  const int reference[] = {6, 10, 20, 38};
  for (int level = 1; level <= 4; ++level) EXPECT_NEAR(steps(level, complementarity::Ties::contact), reference[level - 1], 2) << level;
}
TEST(NewtonSteps, a_cold_start_with_free_ties_takes_fewer) {
  const int reference[] = {4, 8, 13};
  for (int level = 1; level <= 3; ++level) EXPECT_NEAR(steps(level, complementarity::Ties::free), reference[level - 1], 2) << level;
}
TEST(NewtonSteps, a_run_that_may_take_one_step_does_not_converge) {
  auto params = catalogued("smooth contact", 2);
  params.newton.start = complementarity::Start::cold;
  params.newton.max_iterations = 1;
  const Solved run = solve(params);
  EXPECT_FALSE(run.outcome.solved);
  EXPECT_EQ(run.outcome.at.newton_iterations, 1);
  EXPECT_GT(run.outcome.kkt->worst(), 1e-3);
}
TEST(NewtonSteps, no_tolerance_of_the_solver_makes_the_verifier_accept_a_wrong_answer) {
  auto params = catalogued("smooth contact", 2);
  params.newton.start = complementarity::Start::cold;
  params.linear.solver = algebra::SolverKind::gmres;
  params.linear.preconditioner = algebra::PreconditionerKind::ilu;
  params.stopping.nonlinear_tolerance = 0.9;
  params.stopping.linear_tolerance = 0.5;
  const Solved run = solve(params);
  EXPECT_TRUE(run.outcome.solved);
  EXPECT_LE(run.outcome.kkt_tolerance, 1e-3);
  EXPECT_FALSE(run.outcome.kkt->holds(run.outcome.kkt_tolerance));
}
/// Points of multiplier and gap 0 (36 of them here) are opened and closed by rounding: sweeps after a step that has found the contact set
/// would bring back more than it takes off.
TEST(NewtonSteps, smoothing_stops_no_run_above_its_rounding) {
  SKIP_UNLESS_BUILT("hho");
  for (const char* length : {"face", "cell"}) {
    const auto hho = with(by("hho", 2), {{"stabilization length", length}});
    auto params = known_case("disk b", 2, hho);
    params.stopping.linear_tolerance = 1e-12;
    params.stopping.nonlinear_tolerance = 1e-11;
    const Solved run = solve(params);
    EXPECT_TRUE(run.outcome.solved) << run.outcome.finest.why;
    EXPECT_LE(run.outcome.finest.steps, 5);
  }
}
/// What is left of a linear system is compared with the nonlinear residual at the iterate: forces with forces.
TEST(NewtonSteps, the_rule_inexact_saves_krylov_iterations_in_every_form) {
  using algebra::PreconditionerKind;
  using algebra::SolverKind;
  using algebra::SystemForm;
  struct Way {
    const char* deck;
    method::MethodParams method;
    SystemForm form;
    SolverKind solver;
    PreconditionerKind preconditioner;
  };
  const auto p1 = by("fem", 1), p2 = by("fem", 2), hho = by("hho", 1);
  for (const Way& way : {Way{"varying_tension", p1, SystemForm::full, SolverKind::gmres, PreconditionerKind::ilu},
                         Way{"varying_tension", p1, SystemForm::reduced, SolverKind::gmres, PreconditionerKind::ilu},
                         Way{"varying_tension", p2, SystemForm::reduced, SolverKind::cg, PreconditionerKind::muelu},
                         Way{"discontinuous_multiplier", p2, SystemForm::reduced, SolverKind::gmres, PreconditionerKind::ilu},
                         Way{"discontinuous_multiplier", hho, SystemForm::full, SolverKind::gmres, PreconditionerKind::ilu}}) {
    if (!is_built(way.method.name)) continue;
    auto params = from_deck(std::string(way.deck) + ".xml", 2);
    params.method = way.method;
    params.linear.form = way.form;
    params.linear.solver = way.solver;
    params.linear.preconditioner = way.preconditioner;
    params.linear.check_every = 5;
    params.newton.start = complementarity::Start::cold;
    const Solved exact = solve(params);
    params.stopping.rule = complementarity::StoppingRule::inexact;
    const Solved inexact = solve(params);
    const std::string name = std::string(way.deck) + ", " + way.method.name;
    EXPECT_TRUE(inexact.outcome.solved) << name << ": " << inexact.outcome.finest.why;
    EXPECT_LE(inexact.outcome.at.linear_iterations, 0.8 * exact.outcome.at.linear_iterations) << name;
    EXPECT_LE(inexact.outcome.kkt->worst(), 1e-6) << name;
    EXPECT_NEAR(inexact.outcome.energy_norm, exact.outcome.energy_norm, 1e-8 * exact.outcome.energy_norm) << name;
  }
}

}  // namespace thixis::verification
