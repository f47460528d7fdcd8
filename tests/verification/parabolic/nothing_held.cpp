/// Membranes of which nothing is held: in time they have a place all the same.
#include <gtest/gtest.h>

#include <cmath>

#include "march.hpp"
#include "thixis/complementarity/newton.hpp"

namespace thixis::verification {
namespace {

/// f_1 = -1, u_1(0) = h + 1/10, u_2(0) = h: the upper membrane sinks until they meet at t = 1/10; then both sink together, and lambda =
/// 1/2. Force and inertia of a step that ends at the meeting leave nothing but round-off to solve for.
drive::RunParams sinking(std::string method, int degree, const std::string& height = "1") {
  drive::RunParams params = on_squares("", 3, method, degree);
  params.scene.case_name.reset();
  membranes::of(params.scene).data.emplace();
  membranes::DataParams& data = *membranes::of(params.scene).data;
  data.f1 = {"-1"};
  data.u1 = {height + " + (t < 0.1 ? 0.1 - t : (0.1 - t)/2)"};
  data.u2 = {height + " + (t < 0.1 ? 0 : (0.1 - t)/2)"};
  for (const char* side : {"left", "right", "bottom", "top"})
    membranes::of(params.scene).boundary[side].kind = membranes::BoundaryKind::neumann;
  params.newton.scaling = complementarity::Scaling::physical;
  params.stopping = {};
  return params;
}

std::vector<drive::RunParams> all_ways(drive::RunParams params) {
  std::vector<drive::RunParams> all;
  for (const auto form : {algebra::SystemForm::full, algebra::SystemForm::reduced})
    for (const auto solver : {algebra::SolverKind::direct, algebra::SolverKind::gmres, algebra::SolverKind::cg}) {
      if (form == algebra::SystemForm::full && solver == algebra::SolverKind::cg) continue;
      params.linear.form = form;
      params.linear.solver = solver;
      all.push_back(params);
    }
  return all;
}

std::string name_of(const drive::RunParams& params) {
  return params.method.name + " P" + std::to_string(params.method.degree) + ", form " +
         std::to_string(static_cast<int>(params.linear.form)) + ", solver " + std::to_string(static_cast<int>(params.linear.solver));
}

}  // namespace

TEST(NothingHeld, sinks_as_it_should) {
  for (const auto& [method, degree] :
       built(std::vector<std::pair<std::string, int>>{{"fem", 1}, {"fem", 3}, {"dg", 1}, {"dg", 2}, {"hho", 1}, {"hho", 2}}))
    for (const char* height : {"0", "1", "1e3"})
      for (const auto& params : all_ways(sinking(method, degree, height))) {
        const March run = march(params, 4, 0.4);
        EXPECT_TRUE(run.solved) << name_of(params) << " at " << height;
        EXPECT_LE(run.evolution->error_so_far().value(), 1e-7) << name_of(params);
        for (const char* of : {"l2_error_u1", "l2_error_u2"}) EXPECT_LE(run.largest(of), 1e-8) << name_of(params);
        EXPECT_NEAR(run.at(3, "contact_force"), 0.5, 1e-7) << name_of(params);
        EXPECT_LE(run.worst_kkt, 1e-7) << name_of(params);
      }
}

/// Whatever the iterates: their errors have means, which no flux takes away.
TEST(NothingHeld, has_a_bound) {
  for (const auto& [method, degree] : built(std::vector<std::pair<std::string, int>>{{"fem", 1}, {"fem", 2}, {"hho", 1}}))
    for (const double disturbance : {0.0, 1e-2}) {
      const auto params = sinking(method, degree);
      const auto make = method_of(method);
      const auto model = membranes::parabolic_membranes(membranes::membrane_scene(params.scene), make, params.method, params.linear);
      const auto evolution = model->evolve(params.mesh, core::Comm(), "", {});
      auto X = evolution->initial();
      for (int n = 1; n <= 4; ++n) {
        const algebra::Vector before(*X, Teuchos::Copy);
        evolution->begin({0.05 * (n - 1), 0.05 * n}, before);
        EXPECT_TRUE(complementarity::newton(evolution->problem(), *X, params.newton, params.stopping, 10, {}, {}).converged);
        {
          const auto values = algebra::host_view(*X);
          const auto ids = X->getMap();
          for (std::size_t i = 0; i < values.extent(0); ++i)
            values(i) += disturbance * (1 + std::sin(static_cast<double>(ids->getGlobalElement(static_cast<LocalIndex>(i)) % 17)));
        }
        const auto eta = evolution->estimate(*X);
        EXPECT_TRUE(std::isfinite(eta.total));
        EXPECT_LE(eta.total, (1 + 1e-12) * (eta.discretization + eta.linearization + eta.algebraic) + 1e-14);
        evolution->accept(*X);
        const double error = evolution->error_so_far().value();
        EXPECT_GE(evolution->estimate_so_far()->total, error - 1e-12) << name_of(params) << ", step " << n;
        if (disturbance == 0) {
          EXPECT_LE(evolution->estimate_so_far()->total, 1e-6) << name_of(params) << ", step " << n;
        }
      }
    }
}

}  // namespace thixis::verification
