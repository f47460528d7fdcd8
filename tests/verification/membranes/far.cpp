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

/// Measured T_1 … T_7: smooth contact 4 5 4 5 6 7 8, discontinuous multiplier 3 on each, disk b 3 2 1 2 1 2 1. Where the multiplier jumps
/// the steps do not grow; where gap and multiplier both leave zero smoothly, the edge of contact is found one more step later on each
/// level.
TEST(Far, the_steps_of_a_nested_start_stay_below_5_or_grow_by_one_per_level_where_contact_is_smooth) {
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
