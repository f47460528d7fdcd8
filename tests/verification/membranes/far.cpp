/// Finer meshes than the test suite has time for.
#include <gtest/gtest.h>

#include "problems.hpp"

namespace thixis::verification {
namespace {

drive::RunParams by_multigrid(const std::string& name, int level) {
  auto params = catalogued(name, level);
  params.linear.solver = algebra::SolverKind::cg;
  params.linear.preconditioner = algebra::PreconditionerKind::muelu;
  return params;
}

}  // namespace

TEST(Far, the_energy_errors_have_order_1_from_T_3_to_T_6) {
  for (const char* name : {"smooth contact", "discontinuous multiplier", "disk", "disk b"}) {
    double before = 0;
    for (int level = 3; level <= 6; ++level) {
      const Solved run = solve(by_multigrid(name, level));
      ASSERT_TRUE(run.outcome.solved) << name << " on T_" << level << ": " << run.outcome.finest.why;
      const double error = *run.outcome.energy_error;
      if (level > 3) {
        EXPECT_NEAR(order(before, error), 1, 0.05) << name << " on T_" << level;
      }
      std::cout << name << ", T_" << level << ": " << error << ", " << run.outcome.finest.steps << " steps\n";
      before = error;
    }
  }
}

TEST(Far, a_nested_start_takes_at_most_5_steps_on_every_level) {
  for (const char* name : {"smooth contact", "discontinuous multiplier", "disk b"}) {
    std::vector<int> steps(8, 0);
    drive::Observer observer;
    observer.step = [&](const drive::Progress& at, const complementarity::NewtonRecord&) { ++steps[at.level]; };
    const Solved run = solve(by_multigrid(name, 7), core::Comm(), observer);
    ASSERT_TRUE(run.outcome.solved) << name << ": " << run.outcome.finest.why;
    for (int level = 1; level <= 7; ++level) {
      EXPECT_LE(steps[level], 5) << name << " on T_" << level;
      std::cout << name << ", T_" << level << ": " << steps[level] << " steps\n";
    }
  }
}

}  // namespace thixis::verification
