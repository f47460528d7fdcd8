/// One membrane over an obstacle, by all methods.
#include <gtest/gtest.h>

#include <cmath>

#include "problems.hpp"

namespace thixis::verification {
namespace {

drive::RunParams obstacle(const std::string& name, int level, const method::MethodParams& method) {
  auto params = catalogued(name, level);
  params.scene.model = "obstacle";
  params.method = method;
  params.stopping.linear_tolerance = 1e-12;
  params.stopping.nonlinear_tolerance = 1e-11;
  return params;
}

drive::RunParams deck(const std::string& name, int refinements, const method::MethodParams& method) {
  auto params = from_deck("../obstacle/" + name, refinements);
  params.method = method;
  return params;
}

double radial_error(int level, const method::MethodParams& method) {
  auto params = obstacle("radial obstacle", level, method);
  params.mesh.generator = mesh::Generator::disk;
  params.linear.solver = method_of(method.name).symmetric(method) ? algebra::SolverKind::cg : algebra::SolverKind::gmres;
  params.linear.preconditioner = algebra::PreconditionerKind::ilu;
  const Solved run = solve(params);
  EXPECT_TRUE(run.outcome.solved) << run.outcome.finest.why;
  EXPECT_GT(run.outcome.finest.active, 0);
  EXPECT_LE(run.outcome.kkt->worst(), 1e-7);
  return *run.outcome.energy_error;
}

}  // namespace

/// As for the two membranes whose multiplier jumps: order p up to 1.5, the regularity of the solution. From mesh to mesh the order varies
/// with the way the circle cuts the cells; from T_0 to T_3 that evens out.
TEST(Obstacle, with_a_known_radial_solution_has_the_orders_of_a_multiplier_that_jumps) {
  for (int p = 1; p <= 4; ++p)
    for (const auto& [name, method] : all_methods(p)) {
      const double rate = order(radial_error(0, method), radial_error(3, method)) / 3;
      EXPECT_GE(rate, p == 1 ? 0.93 : 1.35) << name;
      EXPECT_LE(rate, p == 1 ? 1.1 : 2) << name;
    }
}

TEST(Obstacle, higher_degrees_are_more_accurate) {
  for (const auto& name : built({"fem", "dg", "hho"})) {
    const double p1 = radial_error(2, by(name, 1)), p2 = radial_error(2, by(name, 2)), p4 = radial_error(2, by(name, 4));
    EXPECT_LT(p2, 0.3 * p1) << name;
    EXPECT_LT(p4, p2) << name;
  }
}

TEST(Obstacle, by_all_methods_with_kinks_and_with_contact_at_the_boundary_ends_with_a_verdict) {
  for (const char* file : {"torsion.xml", "pyramid.xml", "touching.xml"})
    for (int p = 1; p <= 4; ++p)
      for (const auto& [name, method] : all_methods(p)) {
        const Solved run = solve(deck(file, 1, method));
        ASSERT_TRUE(run.outcome.solved) << file << ", " << name << ": " << run.outcome.finest.why;
        EXPECT_TRUE(run.outcome.kkt->holds(1e-6)) << file << ", " << name << ": " << run.outcome.kkt->sentence(1e-6);
        EXPECT_GT(run.outcome.finest.active, 0) << file << ", " << name;
      }
}

TEST(Obstacle, far_below_is_not_felt) {
  for (const auto& [name, method] : all_methods(2)) {
    auto params = deck("pyramid.xml", 1, method);
    membranes::of(params.scene).data->psi.text = "-10";
    const Solved run = solve(params);
    ASSERT_TRUE(run.outcome.solved) << name;
    EXPECT_EQ(run.outcome.finest.active, 0) << name;
    EXPECT_EQ(run.outcome.kkt->between_nodes, 0) << name;
  }
}

/// u >= psi with the lower membrane for an obstacle: u2 = psi, whatever its tension is.
TEST(Obstacle, is_what_two_membranes_are_when_the_lower_one_is_rigid) {
  auto params = obstacle("torsion", 2, by("fem", 1));
  const Solved one = solve(params);
  auto rigid = data({{"mu1", "1"}, {"mu2", "1e5"}, {"f1", "-8"}, {"g1", "0"}, {"g2", "-0.25"}}, 2);
  rigid.stopping.nonlinear_tolerance = 1e-13;  // relative to what holds the lower membrane
  const Solved two = solve(rigid);
  ASSERT_TRUE(one.outcome.solved && two.outcome.solved) << one.outcome.finest.why << two.outcome.finest.why;
  EXPECT_EQ(one.outcome.finest.active, two.outcome.finest.active);
  EXPECT_NEAR(one.outcome.energy_norm, two.outcome.energy_norm, 1e-3 * one.outcome.energy_norm);
}

TEST(Obstacle, gives_the_same_energy_on_any_number_of_ranks_in_full_and_reduced_form) {
  for (int p = 1; p <= 4; ++p)
    for (const auto& [name, method] : all_methods(p)) {
      auto params = obstacle("torsion", 1, method);
      params.mesh.cells_per_rank = 20;
      const Solved alone = solve(params, core::Comm(MPI_COMM_SELF)), together = solve(params);
      params.method.condensation = false;
      params.linear.form = algebra::SystemForm::full;
      const Solved full = solve(params);
      ASSERT_TRUE(alone.outcome.solved && together.outcome.solved && full.outcome.solved) << name;
      EXPECT_NEAR(together.outcome.energy_norm, alone.outcome.energy_norm, 1e-8 * alone.outcome.energy_norm) << name;
      EXPECT_NEAR(full.outcome.energy_norm, alone.outcome.energy_norm, 1e-8 * alone.outcome.energy_norm) << name;
    }
}

}  // namespace thixis::verification
