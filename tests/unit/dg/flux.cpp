/// The flux of interior-penalty dG: balance in every cell whatever u is, continuity, boundary data, accuracy.
#include <gtest/gtest.h>

#include "../method/native_flux.hpp"
#include "thixis/dg/params.hpp"
#include "thixis/dg/space.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::dg {
namespace {

using mesh::Generator;
using method::FluxProblem;
using method::Held;
using method::Space;
using method::Tension;

struct Setting {
  Generator generator;
  int degree;
  Variant variant;
  BoundaryTreatment boundary;
  method::Nodes nodes = method::Nodes::gauss_lobatto;
};

mesh::Hierarchy hierarchy(Generator generator, int refinements) {
  mesh::MeshParams params;
  params.generator = generator;
  params.refinements = refinements;
  params.cells_per_rank = 20;
  if (generator == Generator::disk) params.rings = 3;
  if (generator == Generator::file) params.file = "l_shape_22.msh";
  return mesh::build(params, core::Comm(), MESH_FILES);
}

method::MethodParams params(const Setting& setting) {
  method::MethodParams params;
  params.name = "dg";
  params.degree = setting.degree;
  params.own.get<Params>().variant = setting.variant;
  params.own.get<Params>().boundary = setting.boundary;
  params.nodes = setting.nodes;
  params.own.get<Params>().penalty = 20;
  return params;
}

struct Spaces {
  std::unique_ptr<method::Space> held, free;
  const Space& V = *held;
  const Space& V_free = *free;
};
Spaces spaces(const mesh::Mesh& mesh, const Setting& setting, const std::vector<bool>& dirichlet, Tension tension) {
  const auto level_set = method::interface_of(tension);
  return {make_space(mesh, {dirichlet, level_set, params(setting)}),
          make_space(mesh, {std::vector<bool>(dirichlet.size(), false), level_set, params(setting)})};
}

const auto wave = scene::formula([](double x, double y) { return std::exp(x) * std::cos(2 * y) + 0.3; });

/// u = (0.3 + x - y/2)^p + x - y, mu = 2 + x or 2.
struct Polynomial {
  int p;
  static double inner(double x, double y) { return 0.3 + x - 0.5 * y; }
  double laplacian(double x, double y) const { return p < 2 ? 0 : 1.25 * p * (p - 1) * std::pow(inner(x, y), p - 2); }
  scene::FieldPtr value() const {
    return scene::formula([p = p](double x, double y) { return std::pow(inner(x, y), p) + x - y; });
  }
  scene::FieldPtr force(bool varies) const {
    return scene::formula([*this, varies](double x, double y) {
      return varies ? -(2 + x) * laplacian(x, y) - (p * std::pow(inner(x, y), p - 1) + 1) : -2 * laplacian(x, y);
    });
  }
};

class InteriorPenaltyFlux : public ::testing::TestWithParam<Setting> {
 protected:
  mesh::Hierarchy levels = hierarchy(GetParam().generator, 1);
  const mesh::Mesh& mesh = levels.finest();
};

TEST_P(InteriorPenaltyFlux, balances_the_forces_of_every_cell_whatever_the_field_is) {
  for (const auto tension : {Tension::constant, Tension::smooth, Tension::jump})
    for (const auto held : {Held::all, Held::none, Held::alternating})
      for (const double sign : {1.0, -1.0}) {
        if (tension != Tension::constant && (sign < 0 || held != Held::alternating)) continue;
        const auto dirichlet = method::held_tags(mesh, held);
        const auto s = spaces(mesh, GetParam(), dirichlet, tension);
        const FluxProblem problem{s.V, s.V_free, diffusion, method::tension_of(tension), wave, method::boundary_of(dirichlet, wave, wave),
                                  sign};
        const auto u = s.V.complete(method::arbitrary(s.V, 1), s.V.lift(problem.boundary, 0));
        const auto X3 = method::restricted(s.V, method::arbitrary(s.V, 2));
        const auto sigma = method::flux(problem, u);
        EXPECT_LT(method::imbalance(problem, sigma, method::residual(problem, u, X3), X3), 1e-10);
        EXPECT_GT(method::imbalance(problem, sigma, method::arbitrary(s.V, 3), X3), 1e-6);  // another residual is noticed
        EXPECT_LT(method::discontinuity(problem, sigma), 1e-11);
        EXPECT_LT(method::traction_error(problem, dirichlet, sigma), 1e-11);
      }
}

TEST_P(InteriorPenaltyFlux, is_exact_for_polynomials_of_degree_p) {
  const Polynomial u{GetParam().degree};
  const auto dirichlet = method::held_tags(mesh, Held::all);
  for (const bool varies : {false, true}) {
    const auto s = spaces(mesh, GetParam(), dirichlet, Tension::constant);
    const FluxProblem problem{s.V,
                              s.V_free,
                              diffusion,
                              varies ? scene::formula([](double x, double) { return 2 + x; }) : scene::constant(2),
                              u.force(varies),
                              method::boundary_of(dirichlet, u.value(), nullptr)};
    algebra::Vector values(s.V.map());
    s.V.interpolate(*u.value(), 0, values);
    const auto complete = s.V.complete(values, s.V.lift(problem.boundary, 0));
    EXPECT_LT(method::mismatch(problem, complete, method::flux(problem, complete)),
              1e-10 * std::sqrt(method::energy(*diffusion(s.V, problem.tension), complete)));
  }
}

TEST_P(InteriorPenaltyFlux, approaches_the_gradient_with_order_p) {
  if (GetParam().generator != Generator::criss_cross || GetParam().nodes != method::Nodes::gauss_lobatto) return;
  const int p = GetParam().degree;
  const auto exact = scene::formula([](double x, double y) { return std::sin(2 * x + 1) * std::cosh(y); });
  const method::Gradient gradient = {scene::formula([](double x, double y) { return 2 * std::cos(2 * x + 1) * std::cosh(y); }),
                                     scene::formula([](double x, double y) { return std::sin(2 * x + 1) * std::sinh(y); })};
  const auto fine = hierarchy(Generator::criss_cross, 2);
  double before = 0;
  for (const auto* level : {&mesh, &fine.finest()}) {
    const auto dirichlet = method::held_tags(*level, Held::all);
    const auto s = spaces(*level, GetParam(), dirichlet, Tension::constant);
    const FluxProblem problem{s.V,
                              s.V_free,
                              diffusion,
                              scene::constant(2.5),
                              scene::formula([](double x, double y) { return 7.5 * std::sin(2 * x + 1) * std::cosh(y); }),
                              method::boundary_of(dirichlet, exact, nullptr)};
    const auto u = method::solution(problem);
    const double estimated = method::mismatch(problem, u, method::flux(problem, u));
    const double error = std::sqrt(method::energy_error(*diffusion(s.V, problem.tension), u, {method::Known{gradient}}, 0));
    EXPECT_LT(estimated, 5 * error);
    if (before > 0) {
      EXPECT_GT(std::log2(before / estimated), p - 0.25);
    }
    before = estimated;
  }
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const auto generator : {Generator::criss_cross, Generator::disk, Generator::file})
    for (int p = 1; p <= 4; ++p)
      for (const auto variant : {Variant::sipg, Variant::nipg})
        for (const auto boundary : {BoundaryTreatment::weak, BoundaryTreatment::strong}) {
          all.push_back({generator, p, variant, boundary});
          if (generator == Generator::criss_cross && p == 3) all.push_back({generator, p, variant, boundary, method::Nodes::bernstein});
        }
  return all;
}

std::string name(const ::testing::TestParamInfo<Setting>& info) {
  const auto& s = info.param;
  const char* const generators[] = {"criss_cross", "rectangle", "disk", "gmsh"};
  return std::string(generators[static_cast<int>(s.generator)]) + "_P" + std::to_string(s.degree) +
         (s.variant == Variant::sipg ? "_sipg" : "_nipg") + (s.boundary == BoundaryTreatment::weak ? "_weak" : "_strong") +
         (s.nodes == method::Nodes::bernstein ? "_bernstein" : "");
}
INSTANTIATE_TEST_SUITE_P(Meshes, InteriorPenaltyFlux, ::testing::ValuesIn(settings()), name);

}  // namespace
}  // namespace thixis::dg
