/// What must hold of every method and degree: polynomials, contact everywhere and nowhere, ranks, condensation.
#include <gtest/gtest.h>

#include <cmath>

#include "problems.hpp"

namespace thixis::verification {
namespace {

using algebra::Vector;

/// Every method of every degree with its parameters; the solution is a polynomial of degree p.
template <class F>
void for_each_method(F f) {
  for (int p = 1; p <= 4; ++p)
    for (const auto& [name, method] : all_methods(p)) f(name, method);
}

/// u = (0.3 + x - y/2)^p + x - y, and -Lap u.
std::string polynomial(int p) { return "(0.3 + x - 0.5*y)^" + std::to_string(p) + " + x - y"; }
std::string gradient_x(int p) { return std::to_string(p) + "*(0.3 + x - 0.5*y)^" + std::to_string(p - 1) + " + 1"; }
std::string gradient_y(int p) { return "-0.5*" + std::to_string(p) + "*(0.3 + x - 0.5*y)^" + std::to_string(p - 1) + " - 1"; }
std::string minus_laplacian(int p) {
  return p < 2 ? "0" : std::to_string(-1.25 * p * (p - 1)) + "*(0.3 + x - 0.5*y)^" + std::to_string(p - 2);
}

drive::RunParams membranes(const method::MethodParams& method, const std::string& gap, const std::string& pressure) {
  const int p = method.degree;
  auto params = data({{"mu1", "2"},
                      {"mu2", "0.5"},
                      {"u1", polynomial(p) + " + " + gap},
                      {"u2", polynomial(p)},
                      {"u1_x", gradient_x(p)},
                      {"u1_y", gradient_y(p)},
                      {"u2_x", gradient_x(p)},
                      {"u2_y", gradient_y(p)},
                      {"f1", "2*(" + minus_laplacian(p) + ") - " + pressure},
                      {"f2", "0.5*(" + minus_laplacian(p) + ") + " + pressure}},
                     1);
  params.method = method;
  params.stopping.linear_tolerance = 1e-14;
  params.stopping.nonlinear_tolerance = 1e-12;
  return params;
}

}  // namespace

TEST(Methods, reproduce_polynomials_without_contact) {
  for_each_method([](const std::string& name, const method::MethodParams& method) {
    const Solved run = solve(membranes(method, "0.5", "0"));
    ASSERT_TRUE(run.outcome.solved) << name << ": " << run.outcome.finest.why;
    EXPECT_LE(*run.outcome.energy_error, 1e-11) << name;
    EXPECT_EQ(run.outcome.finest.active, 0) << name;
  });
}

TEST(Methods, reproduce_polynomials_with_contact_everywhere) {
  for_each_method([](const std::string& name, const method::MethodParams& method) {
    const Solved run = solve(membranes(method, "0", "3"));
    ASSERT_TRUE(run.outcome.solved) << name << ": " << run.outcome.finest.why;
    EXPECT_LE(*run.outcome.energy_error, 1e-11) << name;
    EXPECT_GT(run.outcome.finest.active, 0) << name;
    EXPECT_LE(run.outcome.kkt->worst(), 1e-9) << name;
  });
}

TEST(Methods, give_the_same_energy_on_any_number_of_ranks) {
  for_each_method([](const std::string& name, const method::MethodParams& method) {
    auto params = catalogued("discontinuous multiplier", 1);
    params.method = method;
    params.mesh.cells_per_rank = 20;
    params.stopping.linear_tolerance = 1e-13;
    params.stopping.nonlinear_tolerance = 1e-11;
    const Solved together = solve(params), alone = solve(params, core::Comm(MPI_COMM_SELF));
    ASSERT_TRUE(together.outcome.solved && alone.outcome.solved) << name << ": " << together.outcome.finest.why;
    EXPECT_NEAR(together.outcome.energy_norm, alone.outcome.energy_norm, 1e-8 * alone.outcome.energy_norm) << name;
    EXPECT_NEAR(*together.outcome.energy_error, *alone.outcome.energy_error, 1e-6 * *alone.outcome.energy_error) << name;
    EXPECT_NEAR(together.outcome.kkt->between_nodes, alone.outcome.kkt->between_nodes, 1e-8) << name;
  });
}

TEST(Methods, agree_in_full_and_reduced_form) {
  for_each_method([](const std::string& name, const method::MethodParams& method) {
    auto params = pressed("1 + x", "2 - y", 1);
    params.method = method;
    params.method.condensation = false;
    params.mesh.cells_per_rank = 20;
    params.stopping.linear_tolerance = 1e-13;
    params.stopping.nonlinear_tolerance = 1e-11;
    const Solved reduced = solve(params);
    params.linear.form = algebra::SystemForm::full;
    const Solved full = solve(params);
    ASSERT_TRUE(reduced.outcome.solved && full.outcome.solved) << name << ": " << reduced.outcome.finest.why << full.outcome.finest.why;
    EXPECT_NEAR(reduced.outcome.energy_norm, full.outcome.energy_norm, 1e-8 * full.outcome.energy_norm) << name;
    EXPECT_EQ(reduced.outcome.finest.active, full.outcome.finest.active) << name;
  });
}

namespace {

std::size_t allocations = 0;

/// Kokkos allocations of: space, matrix, load, residual cell by cell, error on T_level, with constant or varying data.
std::size_t allocations_on(int level, const method::MethodParams& method, const std::string& tension) {
  auto params = pressed(tension, tension, level);
  const mesh::Hierarchy hierarchy = mesh::build(params.mesh, core::Comm(MPI_COMM_SELF), "");
  const mesh::Mesh& mesh = hierarchy.finest();
  const auto scene = membranes::membrane_scene(params.scene);
  const method::BoundaryValues boundary = {std::vector<scene::FieldPtr>(mesh.tags.size(), scene::constant(1)),
                                           std::vector<scene::FieldPtr>(mesh.tags.size(), nullptr)};
  Kokkos::Tools::Experimental::set_allocate_data_callback(
      [](Kokkos_Profiling_SpaceHandle, const char*, const void*, const std::uint64_t) { ++allocations; });
  allocations = 0;
  {
    const method::Method chosen = method_of(method.name);
    const auto space = chosen.make_space(mesh, {std::vector<bool>(mesh.tags.size(), true), nullptr, method});
    Vector F(space->map());
    method::load(*chosen.diffusion(*space, scene.tension[0]), *scene.force[0], boundary, 0, F);
    const auto S = method::assemble(*chosen.diffusion(*space, scene.tension[0]));
    const auto u = space->complete(F, space->lift(boundary, 0));
    method::apply(*chosen.diffusion(*space, scene.tension[0]), u, F);
    method::energy_error(*chosen.diffusion(*space, scene.tension[0]), u, {method::Known{{scene::constant(0), scene::constant(0)}}}, 0);
  }
  Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr);
  return allocations;
}

}  // namespace

TEST(Methods, allocate_nothing_per_cell) {
  for_each_method([](const std::string& name, const method::MethodParams& method) {
    for (const char* tension : {"2", "1 + x"}) {
      const std::size_t coarse = allocations_on(1, method, tension);
      EXPECT_GT(coarse, 10u);
      EXPECT_EQ(allocations_on(3, method, tension), coarse) << name;
    }
  });
}

/// Static condensation is exact algebra: all Newton iterates stay the same.
class Condensed : public ::testing::TestWithParam<complementarity::CFunction> {
 protected:
  std::vector<Vector> iterates(drive::RunParams params, const method::MethodParams& method, bool condensed) {
    params.method = method;
    params.method.condensation = condensed;
    params.newton.c_function = GetParam();
    params.newton.start = complementarity::Start::cold;
    params.mesh.cells_per_rank = 20;
    std::vector<Vector> all;
    drive::Observer observer;
    observer.iterate = [&](const drive::Position&, const models::Discretization&, const Vector& X) { all.emplace_back(X, Teuchos::Copy); };
    const Solved run = solve(params, core::Comm(), observer);
    EXPECT_TRUE(run.outcome.solved) << run.outcome.finest.why;
    return all;
  }

  void expect_equal(const drive::RunParams& params, const method::MethodParams& method, const std::string& name) {
    const auto without = iterates(params, method, false), with = iterates(params, method, true);
    ASSERT_EQ(without.size(), with.size()) << name;
    for (std::size_t k = 0; k < with.size(); ++k) {
      Vector difference(with[k], Teuchos::Copy);
      difference.update(-1, without[k], 1);
      EXPECT_LE(difference.normInf(), 1e-9 * without[k].normInf()) << name << ", step " << k + 1;
    }
  }
};

TEST_P(Condensed, hho_has_the_iterates_of_the_uncondensed_systems) {
  SKIP_UNLESS_BUILT("hho");
  for (int level = 0; level <= 2; ++level)
    for (int p = 1; p <= 4; ++p)
      for (const char* problem : {"smooth contact", "discontinuous multiplier"})
        expect_equal(catalogued(problem, level), by("hho", p), std::string(problem) + ", P" + std::to_string(p));
}
TEST_P(Condensed, hho_with_varying_tensions_has_the_iterates_of_the_uncondensed_systems) {
  SKIP_UNLESS_BUILT("hho");
  for (int p = 1; p <= 4; ++p) expect_equal(pressed("1 + x", "2 - y", 1), by("hho", p), "P" + std::to_string(p));
}
TEST_P(Condensed, bubbles_of_fem_have_the_iterates_of_the_uncondensed_systems) {
  for (int p = 3; p <= 4; ++p)
    for (const auto& params : {catalogued("discontinuous multiplier", 1), pressed("1", "3", 1), pressed("1 + x", "2 - y", 1)})
      expect_equal(params, by("fem", p), "P" + std::to_string(p));
}
INSTANTIATE_TEST_SUITE_P(CFunction, Condensed,
                         ::testing::Values(complementarity::CFunction::min, complementarity::CFunction::fischer_burmeister),
                         [](const auto& chosen) { return chosen.param == complementarity::CFunction::min ? "min" : "fischer_burmeister"; });

}  // namespace thixis::verification
