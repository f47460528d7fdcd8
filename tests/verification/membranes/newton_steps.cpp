/// The number of semismooth Newton steps against counts computed independently (scaling s = 1, as there).
#include <gtest/gtest.h>

#include "problems.hpp"

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

}  // namespace thixis::verification
