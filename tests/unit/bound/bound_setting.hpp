#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "equilibration/flux_checks.hpp"
#include "feasible_setting.hpp"
#include "thixis/bound/guaranteed_bound.hpp"
#include "thixis/mesh/adapt.hpp"

/// What the tests of the bounds share: meshes of all kinds, and iterates that solve nothing.
namespace thixis::bound {

using algebra::Vector;
using equilibration::divergence_error;
using equilibration::jump_of_normal_flux;

inline mesh::Hierarchy hierarchy_of(const std::string& name) {
  mesh::MeshParams params;
  params.cells_per_side = 1;
  params.rings = 1;
  params.refinements = 2;
  params.cells_per_rank = 4;
  if (name == "disk") params.generator = mesh::Generator::disk;
  if (name == "file") {
    params.generator = mesh::Generator::file;
    params.file = "l_shape_22.msh";
    params.refinements = 0;
  }
  if (name == "refined file") {
    params.generator = mesh::Generator::file;
    params.file = "l_shape_22.msh";
    params.refinements = 1;
  }
  if (name.find("adaptive") != std::string::npos) params.refinements = 1;
  if (name == "adaptive disk") params.generator = mesh::Generator::disk;
  auto levels = mesh::build(params, core::Comm(), MESH_FILES);
  for (int k = 0; k < 2 && name.find("adaptive") != std::string::npos; ++k) {
    std::vector<LocalIndex> marked;
    for (LocalIndex K = 0; K < levels.finest().owned_cells; ++K)
      if (levels.finest().cell_id[K] % 5 == 0) marked.push_back(K);
    mesh::adapt(levels, marked);
  }
  return levels;
}

class BoundSetting : public ::testing::TestWithParam<std::string> {
 protected:
  const mesh::Hierarchy levels = hierarchy_of(GetParam());
  const mesh::Mesh& mesh = levels.finest();
  const int level = static_cast<int>(levels.levels.size()) - 1;

  struct Case {
    std::vector<bool> held;
    ContactProblem problem;
    std::unique_ptr<Space> V;
    Coefficients u[2];
    std::unique_ptr<Vector> lambda, gap, residual[2];
    Iterate iterate() const {
      Iterate it;
      for (int alpha = 0; alpha < problem.count; ++alpha) {
        it.u[alpha] = u[alpha];
        it.residual[alpha] = residual[alpha].get();
      }
      it.lambda = lambda.get();
      it.gap = gap.get();
      return it;
    }
  };

  /// A polynomial, so that every quadrature is exact.
  static FieldPtr force(int alpha) {
    return scene::formula([alpha](double x, double y) { return 0.7 + x * x * y - (2 - alpha) * y * y + x; });
  }

  /// `shift` moves the multiplier: at 0 it has both signs.
  Case arbitrary(const Setting& setting, bool varying, bool neumann, int count, double shift = 0) const {
    Case c;
    c.held.assign(mesh.tags.size(), true);
    for (std::size_t tag = 1; neumann && tag < c.held.size(); tag += 2) c.held[tag] = false;
    const auto wave = [](double a, double b, double height) {
      return scene::formula([=](double x, double y) { return height + std::sin(a * x + b * y + height); });
    };
    c.problem.count = count;
    if (count == 1) c.problem.obstacle = scene::formula([](double x, double y) { return -3 - x * x - y * y; });
    for (int alpha = 0; alpha < count; ++alpha) {
      const double mu = 2 - alpha;
      c.problem.tension[alpha] =
          varying ? scene::formula([=](double x, double y) { return mu + 0.5 * std::sin(x - 2 * y); }) : scene::constant(mu);
      c.problem.force[alpha] = force(alpha);
      for (const bool held : c.held) {
        c.problem.boundary[alpha].dirichlet.push_back(held ? wave(1, 2, 2 - 3 * alpha) : nullptr);
        c.problem.boundary[alpha].neumann.push_back(held ? nullptr : wave(2, -1, 0.3 + alpha));
      }
    }
    method::MethodParams params;
    params.name = setting.name;
    params.degree = setting.degree;
    params.nodes = setting.nodes;
    const method::SpaceOptions options{c.held, nullptr, params};
    const method::Method& by = tests::method_of(setting.name);
    c.V = by.make_space(mesh, options);
    for (int alpha = 0; alpha < count; ++alpha) c.problem.form[alpha] = by.diffusion(*c.V, c.problem.tension[alpha]);
    c.lambda = std::make_unique<Vector>(c.V->points());
    c.gap = std::make_unique<Vector>(c.V->points());
    const auto ids = c.V->unknown_ids();
    const auto number = [&](std::size_t row, int seed) { return std::sin(12.9898 * static_cast<double>(ids[row] % 100003) + seed); };
    {
      const auto lambda = algebra::host_overwrite(*c.lambda), gap = algebra::host_overwrite(*c.gap);
      for (std::size_t l = 0; l < lambda.extent(0); ++l) {
        lambda(l) = number(l, 1) + shift;
        gap(l) = number(l, 2);
      }
    }
    Vector D_lambda(c.V->map());
    {
      const auto out = algebra::host_view(D_lambda);
      const Vector& X3 = *c.lambda;
      const auto lambda = algebra::host_view(X3), D = algebra::host_view(c.V->pairing());
      for (std::size_t l = 0; l < lambda.extent(0); ++l) out(l) = D(l) * lambda(l);
    }
    for (int alpha = 0; alpha < count; ++alpha) {
      Vector values(c.V->map()), forces(c.V->map());
      {
        const auto out = algebra::host_overwrite(values);
        for (std::size_t row = 0; row < out.extent(0); ++row) out(row) = number(row, 3 + alpha);
      }
      c.u[alpha] = c.V->complete(values, c.V->lift(c.problem.boundary[alpha], 0));
      c.residual[alpha] = std::make_unique<Vector>(c.V->map());
      method::load(*c.problem.form[alpha], *c.problem.force[alpha], c.problem.boundary[alpha], 0, *c.residual[alpha]);
      method::apply(*c.problem.form[alpha], c.u[alpha], forces);
      c.residual[alpha]->update(-1, forces, alpha == 0 ? 1 : -1, D_lambda, 1);
    }
    return c;
  }

  /// Worst of the identities: the divergence of each part, of their sum, its continuity.
  struct Errors {
    double total = 0, linearization = 0, algebraic = 0, jump = 0;
    double worst() const { return std::max(std::max(total, jump), std::max(linearization, algebraic)); }
  };
  template <class AnyBound>
  Errors errors(const AnyBound& bound, int alpha) const {
    const auto flux = bound.fluxes(alpha);
    const int q = bound.flux_degree();
    const CellTable sum("sum", mesh.owned_cells, flux.discretization.extent(1));
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int i = 0; i < sum.extent_int(1); ++i) sum(K, i) = flux.discretization(K, i) + flux.linearization(K, i) + flux.algebraic(K, i);
    return {divergence_error(mesh, q, sum, flux.density), divergence_error(mesh, q, flux.linearization, flux.residual_linearization),
            divergence_error(mesh, q, flux.algebraic, flux.residual_algebraic), jump_of_normal_flux(mesh, q, sum)};
  }
};

inline const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = [] {
    std::vector<Setting> settings;
    for (const auto& name : tests::built({"fem", "dg", "hho"}))
      for (int p = 1; p <= 4; ++p) settings.push_back({name, p});
    if (core::Comm().size() > 1) return settings;
    settings.push_back({"fem", 2, Nodes::bernstein});
    settings.push_back({"fem", 3, Nodes::bernstein});
    settings.push_back({"fem", 4, Nodes::equispaced});
    return settings;
  }();
  return all;
}
inline std::string named(const Setting& setting) { return setting.name + " P" + std::to_string(setting.degree); }

inline std::string underscored(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name)
    if (letter == ' ' || letter == '-') letter = '_';
  return name;
}

}  // namespace thixis::bound
