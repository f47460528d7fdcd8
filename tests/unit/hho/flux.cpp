/// The flux of HHO: balance in every cell whatever u is, continuity, boundary data, accuracy.
#include <gtest/gtest.h>

#include "../method/native_flux.hpp"
#include "problems.hpp"
#include "thixis/hho/params.hpp"

namespace thixis::hho {
namespace {

using mesh::Generator;
using method::FluxProblem;
using method::Held;
using method::Space;
using method::Tension;

struct Spaces {
  std::unique_ptr<method::Space> held, free;
  const Space& V = *held;
  const Space& V_free = *free;
};
Spaces spaces(const mesh::Mesh& mesh, const method::MethodParams& params, const std::vector<bool>& dirichlet, Tension tension) {
  const auto level_set = method::interface_of(tension);
  return {make_space(mesh, {dirichlet, level_set, params}),
          make_space(mesh, {std::vector<bool>(dirichlet.size(), false), level_set, params})};
}

class HybridFlux : public ::testing::TestWithParam<Setting> {
 protected:
  mesh::Hierarchy levels = hierarchy(GetParam().generator, 1);
  const mesh::Mesh& mesh = levels.finest();
  method::MethodParams deck = params(GetParam().degree, GetParam().nodes);
};

const auto wave = scene::formula([](double x, double y) { return std::exp(x) * std::cos(2 * y) + 0.3; });

TEST_P(HybridFlux, balances_the_forces_of_every_cell_whatever_the_field_is) {
  for (const auto tension : {Tension::constant, Tension::smooth, Tension::jump})
    for (const auto held : {Held::all, Held::none, Held::alternating})
      for (const double sign : {1.0, -1.0}) {
        deck.own.get<Params>().stabilization_length = sign > 0 ? StabilizationLength::face : StabilizationLength::cell;
        const auto dirichlet = method::held_tags(mesh, held);
        const auto s = spaces(mesh, deck, dirichlet, tension);
        const FluxProblem problem{s.V, s.V_free, diffusion, method::tension_of(tension), wave, method::boundary_of(dirichlet, wave, wave),
                                  sign};
        const auto u = s.V.complete(method::arbitrary(s.V, 1), s.V.lift(problem.boundary, 0));
        const auto X3 = method::restricted(s.V, method::arbitrary(s.V, 2));
        const auto sigma = method::flux(problem, u);
        EXPECT_LT(method::imbalance(problem, sigma, method::residual(problem, u, X3), X3), 1e-10);
        EXPECT_LT(method::discontinuity(problem, sigma), 1e-11);
        EXPECT_LT(method::traction_error(problem, dirichlet, sigma), 1e-11);
      }
}

/// The moments against 1 of all cells together are those of the residual: no force is lost or counted twice.
TEST_P(HybridFlux, shares_out_the_residuals_of_faces) {
  const auto dirichlet = method::held_tags(mesh, Held::alternating);
  const auto s = spaces(mesh, deck, dirichlet, Tension::constant);
  const auto R = method::arbitrary(s.V, 3);
  const method::View<double**> r("r", s.V.cells().extent(0), s.V.basis().size());
  s.V.share(R, r);
  double shared = 0, of_R = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int l = 0; l < s.V.basis().size(); ++l) shared += r(K, l);
  const auto values = algebra::host_view(R);
  const auto ids = s.V.unknown_ids();
  const GlobalIndex of_cells = s.V.coefficients().global_cell_entries;
  for (std::size_t row = 0; row < ids.size(); ++row)
    if (ids[row] < of_cells || (ids[row] - of_cells) % GetParam().degree == 0) of_R += values(row);
  EXPECT_NEAR(mesh.comm.sum(shared), mesh.comm.sum(of_R), 1e-9);
}

TEST_P(HybridFlux, is_exact_for_polynomials_of_degree_p) {
  const Polynomial u{GetParam().degree};
  const auto dirichlet = method::held_tags(mesh, Held::all);
  const auto s = spaces(mesh, deck, dirichlet, Tension::constant);
  const FluxProblem problem{s.V,
                            s.V_free,
                            diffusion,
                            scene::constant(2.5),
                            scene::formula([u](double x, double y) { return 2.5 * u.minus_laplacian(x, y); }),
                            method::boundary_of(dirichlet, u.value(), nullptr)};
  algebra::Vector values(s.V.map());
  s.V.interpolate(*u.value(), 0, values);
  const auto complete = s.V.complete(values, s.V.lift(problem.boundary, 0));
  EXPECT_LT(method::mismatch(problem, complete, method::flux(problem, complete)),
            1e-10 * std::sqrt(method::energy(*diffusion(s.V, problem.tension), complete)));
}

std::vector<Setting> flux_settings() {
  std::vector<Setting> chosen;
  for (const auto& setting : settings())
    if (setting.nodes == method::Nodes::gauss_lobatto || (setting.nodes == method::Nodes::bernstein && setting.degree == 3))
      chosen.push_back(setting);
  return chosen;
}
std::string flux_name(const ::testing::TestParamInfo<Setting>& info) { return name(info.param); }
INSTANTIATE_TEST_SUITE_P(Meshes, HybridFlux, ::testing::ValuesIn(flux_settings()), flux_name);

TEST(HybridFluxes, approach_the_gradient_with_order_p) {
  for (int p = 1; p <= 4; ++p) {
    double before = 0;
    for (const int level : {1, 2}) {
      const auto levels = hierarchy(Generator::criss_cross, level);
      const auto& mesh = levels.finest();
      const auto dirichlet = method::held_tags(mesh, Held::alternating);
      const auto s = spaces(mesh, params(p), dirichlet, Tension::constant);
      const auto exact = scene::formula([](double x, double y) { return std::sin(2 * x + 1) * std::cosh(y); });
      const method::Gradient gradient = {scene::formula([](double x, double y) { return 2 * std::cos(2 * x + 1) * std::cosh(y); }),
                                         scene::formula([](double x, double y) { return std::sin(2 * x + 1) * std::sinh(y); })};
      auto boundary = method::boundary_of(dirichlet, exact, nullptr);
      const auto host = mesh::on_host(mesh);
      for (LocalIndex F = 0; F < mesh.faces; ++F)
        if (host.face_tag(F) >= 0 && !dirichlet[host.face_tag(F)]) {
          const auto face = mesh::face_geometry(host.coordinates, host.face_vertices, F);
          const double out = host.face_cells(F, 0) >= 0 ? 2.5 : -2.5, nx = out * face.normal[0], ny = out * face.normal[1];
          boundary.neumann[host.face_tag(F)] = scene::formula(
              [=](double x, double y) { return nx * 2 * std::cos(2 * x + 1) * std::cosh(y) + ny * std::sin(2 * x + 1) * std::sinh(y); });
        }
      const FluxProblem problem{s.V,
                                s.V_free,
                                diffusion,
                                scene::constant(2.5),
                                scene::formula([](double x, double y) { return 7.5 * std::sin(2 * x + 1) * std::cosh(y); }),
                                boundary};
      const auto u = method::solution(problem);
      const double estimated = method::mismatch(problem, u, method::flux(problem, u));
      const double error = std::sqrt(method::energy_error(*diffusion(s.V, problem.tension), u, {method::Known{gradient}}, 0));
      EXPECT_LT(estimated, 2 * error);
      if (level > 1) {
        EXPECT_GT(std::log2(before / estimated), p - 0.1);
      }
      before = estimated;
    }
  }
}

}  // namespace
}  // namespace thixis::hho
