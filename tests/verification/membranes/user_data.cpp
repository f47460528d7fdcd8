/// Problems given by expressions, boundary data by part, and meshes of all generators.
#include <gtest/gtest.h>

#include "problems.hpp"

namespace thixis::verification {
namespace {

membranes::BoundaryParams neumann(const std::string& t1, const std::string& t2) {
  membranes::BoundaryParams part;
  part.kind = membranes::BoundaryKind::neumann;
  part.t1.text = t1;
  part.t2.text = t2;
  return part;
}

void expect_order_1(const std::function<drive::RunParams(int)>& on_level, int finest) {
  const Solved coarse = solve(on_level(finest - 1)), fine = solve(on_level(finest));
  ASSERT_TRUE(coarse.outcome.solved && fine.outcome.solved);
  EXPECT_NEAR(order(*coarse.outcome.energy_error, *fine.outcome.energy_error), 1, 0.05);
  EXPECT_LE(fine.outcome.kkt->worst(), 1e-8);
}

/// Far from each other: u1 = 3 + sin(x) (1 + y^2), u2 = -2 + x y, tensions 2 and 1 + x.
std::map<std::string, std::string> apart() {
  return {{"mu1", "2"}, {"mu2", "1 + x"}, {"u1", "3 + sin(x)*(1 + y^2)"}, {"u2", "-2 + x*y"}, {"f1", "2*sin(x)*(1 + y^2) - 4*sin(x)"},
          {"f2", "-y"}};
}

}  // namespace

TEST(UserData, by_expressions_reproduce_the_catalogued_case) {
  for (int level = 1; level <= 2; ++level) {
    const Solved known = solve(catalogued("discontinuous multiplier", level)), given = solve(from_deck("user_data.xml", level));
    ASSERT_TRUE(given.outcome.solved) << given.outcome.finest.why;
    EXPECT_NEAR(*given.outcome.energy_error, *known.outcome.energy_error, 1e-8 * *known.outcome.energy_error);
    EXPECT_NEAR(given.outcome.energy_norm, known.outcome.energy_norm, 1e-8 * known.outcome.energy_norm);
    EXPECT_EQ(given.outcome.at.newton_iterations, known.outcome.at.newton_iterations);
  }
}

TEST(UserData, without_derivatives_of_the_solution_they_are_formed_by_differences) {
  auto params = from_deck("user_data.xml", 2);
  const double error = *solve(params).outcome.energy_error;
  membranes::of(params.scene).data->u1_x = membranes::of(params.scene).data->u1_y = {};
  EXPECT_NEAR(*solve(params).outcome.energy_error, error, 1e-6 * error);
}

TEST(UserData, with_neumann_data_on_one_side_have_order_1_without_contact) {
  expect_order_1(
      [](int level) {
        auto params = data(apart(), level);
        membranes::of(params.scene).boundary["right"] = neumann("2*cos(x)*(1 + y^2)", "(1 + x)*y");
        return params;
      },
      3);
}

TEST(UserData, with_neumann_data_on_three_sides_of_a_rectangle_have_order_1) {
  expect_order_1(
      [](int level) {
        auto params = data(apart(), level);
        params.mesh.generator = mesh::Generator::rectangle;
        params.mesh.lower = {0, -0.5};
        params.mesh.upper = {1, 1.5};
        membranes::of(params.scene).boundary["left"] = neumann("-2*cos(x)*(1 + y^2)", "-(1 + x)*y");
        membranes::of(params.scene).boundary["top"] = neumann("4*y*sin(x)", "(1 + x)*x");
        membranes::of(params.scene).boundary["bottom"] = neumann("-4*y*sin(x)", "-(1 + x)*x");
        return params;
      },
      3);
}

TEST(UserData, a_wrong_sign_of_the_neumann_data_shows_in_the_error) {
  auto params = data(apart(), 2);
  membranes::of(params.scene).boundary["right"] = neumann("2*cos(x)*(1 + y^2)", "(1 + x)*y");
  const double error = *solve(params).outcome.energy_error;
  membranes::of(params.scene).boundary["right"] = neumann("-2*cos(x)*(1 + y^2)", "(1 + x)*y");
  EXPECT_GT(*solve(params).outcome.energy_error, 10 * error);
}

TEST(UserData, with_neumann_data_and_contact_have_order_1) {
  expect_order_1([](int level) { return from_deck("neumann.xml", level); }, 3);
}
TEST(UserData, with_varying_tensions_have_order_1) {
  expect_order_1([](int level) { return from_deck("varying_tension.xml", level); }, 3);
}

TEST(UserData, on_a_gmsh_mesh_follow_the_physical_names) {
  const auto params = from_deck("gmsh_plate.xml", 1);
  const Solved run = solve(params);
  ASSERT_TRUE(run.outcome.solved) << run.outcome.finest.why;
  EXPECT_LE(run.outcome.kkt->worst(), 1e-8);
  EXPECT_GT(run.outcome.finest.active, 100);
  auto pulled = params;  // a part of the boundary that is pulled up lifts the membrane off
  membranes::of(pulled.scene).boundary.at("hole").t1.text = "5";
  EXPECT_LT(solve(pulled).outcome.finest.active, run.outcome.finest.active / 2);
}

}  // namespace thixis::verification
