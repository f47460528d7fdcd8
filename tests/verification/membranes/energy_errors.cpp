/// The energy errors of the catalogued cases against reference values computed independently, and their orders.
#include <gtest/gtest.h>

#include "problems.hpp"

namespace thixis::verification {
namespace {

/// Errors on T_0 … T_4; those on T_0 … T_3 within 0.5 % of the reference, order 1 between the last two.
void expect_errors(const std::string& name, const std::vector<double>& reference) {
  double before = 0;
  for (int level = 0; level <= 4; ++level) {
    auto deck = catalogued(name, level);
    deck.stopping.linear_tolerance = 1e-12;
    deck.stopping.nonlinear_tolerance = 1e-11;
    const Solved run = solve(deck);
    ASSERT_TRUE(run.outcome.solved) << name << " on T_" << level << ": " << run.outcome.finest.why;
    const double error = *run.outcome.energy_error;
    if (level < 4 && !reference.empty()) {
      EXPECT_NEAR(error, reference[level], 5e-3 * reference[level]) << name << " on T_" << level;
    }
    if (level == 4) {
      EXPECT_NEAR(order(before, error), 1, 0.05) << name;
    }
    if (level > 0) {
      EXPECT_LE(run.outcome.finest.steps, 5) << name << " on T_" << level << ": steps of a nested start";
    }
    EXPECT_LE(run.outcome.kkt->worst(), 1e-8) << name << " on T_" << level;
    before = error;
  }
}

}  // namespace

TEST(EnergyErrors, smooth_contact_has_the_reference_errors_and_order_1) {
  expect_errors("smooth contact", {7.0116e-03, 3.8682e-03, 1.8818e-03, 9.2518e-04});
}
TEST(EnergyErrors, discontinuous_multiplier_has_the_reference_errors_and_order_1) {
  expect_errors("discontinuous multiplier", {9.2208e-02, 4.7241e-02, 2.3828e-02, 1.1927e-02});
}
TEST(EnergyErrors, disk_b_has_the_reference_errors_and_order_1) {
  expect_errors("disk b", {8.9151e-02, 4.5423e-02, 2.3648e-02, 1.1822e-02});
}
TEST(EnergyErrors, disk_has_order_1_and_holds_the_contact_conditions_to_1e_8) { expect_errors("disk", {}); }

TEST(Sizes, smooth_contact_has_so_many_unknowns_and_is_not_solved_with_no_iterations) {
  const GlobalIndex unknowns[] = {75, 339, 1443, 5955, 24195};
  for (int level = 0; level <= 4; ++level) {
    auto params = catalogued("smooth contact", level);
    params.newton.max_iterations = 0;
    const Solved run = solve(params);
    EXPECT_EQ(run.outcome.discretization->sizes().unknowns_all, unknowns[level]);
    EXPECT_TRUE(run.outcome.not_wanted);
    EXPECT_EQ(run.outcome.at.newton_iterations, 0);
  }
}

}  // namespace thixis::verification
