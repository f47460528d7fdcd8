/// The equations that make the bound a bound, at iterates that solve nothing: fluxes in equilibrium with data and multiplier, residuals
/// that are taken up by their own fluxes, a multiplier that is nowhere negative.
#include <gtest/gtest.h>

#include <cmath>

#include "feasible_setting.hpp"
#include "flux_checks.hpp"
#include "thixis/equilibration/guaranteed_bound.hpp"
#include "thixis/mesh/adapt.hpp"

namespace thixis::equilibration {
namespace {

using algebra::Vector;

mesh::Hierarchy hierarchy_of(const std::string& name) {
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

class Bound : public ::testing::TestWithParam<std::string> {
 protected:
  const mesh::Hierarchy levels = hierarchy_of(GetParam());
  const mesh::Mesh& mesh = levels.finest();
  const int level = static_cast<int>(levels.levels.size()) - 1;

  struct Case {
    std::vector<bool> held;
    ContactProblem problem;
    std::unique_ptr<PolynomialSpace> V;
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
    auto space = setting.name == MethodName::fem  ? fem::make_lagrange_space(mesh, options)
                 : setting.name == MethodName::dg ? dg::make_space(mesh, options)
                                                  : hho::make_space(mesh, options);
    c.V.reset(dynamic_cast<PolynomialSpace*>(space.release()));
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
      c.V->load(*c.problem.tension[alpha], *c.problem.force[alpha], c.problem.boundary[alpha], 0, *c.residual[alpha]);
      c.V->forces(*c.problem.tension[alpha], c.u[alpha], forces);
      c.residual[alpha]->update(-1, forces, alpha == 0 ? 1 : -1, D_lambda, 1);
    }
    return c;
  }

  /// Worst of the identities: the divergence of each part, of their sum, its continuity.
  struct Errors {
    double total = 0, linearization = 0, algebraic = 0, jump = 0;
    double worst() const { return std::max(std::max(total, jump), std::max(linearization, algebraic)); }
  };
  Errors errors(const GuaranteedBound& bound, int alpha) const {
    const auto flux = bound.fluxes(alpha);
    const int q = bound.flux_degree();
    const CellTable sum("sum", mesh.owned_cells, flux.discretization.extent(1));
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int i = 0; i < sum.extent_int(1); ++i) sum(K, i) = flux.discretization(K, i) + flux.linearization(K, i) + flux.algebraic(K, i);
    return {divergence_error(mesh, q, sum, flux.density), divergence_error(mesh, q, flux.linearization, flux.residual_linearization),
            divergence_error(mesh, q, flux.algebraic, flux.residual_algebraic), jump_of_normal_flux(mesh, q, sum)};
  }

  /// The least value of a density on a lattice in all cells, over the largest.
  double least(const ConstCellTable& density, int q) const {
    double low = 0, high = 1e-300;
    const reference::Modal modal(q);
    constexpr int sides = 7;
    std::vector<double> points;
    for (int i = 0; i <= sides; ++i)
      for (int j = 0; i + j <= sides; ++j) points.insert(points.end(), {double(i) / sides, double(j) / sides});
    const int count = static_cast<int>(points.size() / 2);
    const auto phi = modal.values(count, points.data());
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int point = 0; point < count; ++point) {
        double value = 0;
        for (int m = 0; m < modal.size(); ++m) value += phi[point * modal.size() + m] * density(K, m);
        low = std::min(low, value);
        high = std::max(high, value);
      }
    return mesh.comm.min(low) / mesh.comm.max(high);
  }
};

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = [] {
    std::vector<Setting> settings;
    for (const auto name : {MethodName::fem, MethodName::dg, MethodName::hho})
      for (int p = 1; p <= 4; ++p) settings.push_back({name, p});
    if (core::Comm().size() > 1) return settings;
    settings.push_back({MethodName::fem, 2, Nodes::bernstein});
    settings.push_back({MethodName::fem, 3, Nodes::bernstein});
    settings.push_back({MethodName::fem, 4, Nodes::equispaced});
    return settings;
  }();
  return all;
}
std::string named(const Setting& setting) { return method::to_text(setting.name) + " P" + std::to_string(setting.degree); }

TEST_P(Bound, has_fluxes_in_equilibrium_with_data_and_multiplier_and_with_the_residuals) {
  struct Data {
    bool varying, neumann;
    int count;
  };
  for (const auto& setting : settings())
    for (const auto& [varying, neumann, count] : {Data{false, false, 2}, Data{true, true, 2}, Data{false, true, 1}}) {
      const auto c = arbitrary(setting, varying, neumann, count);
      GuaranteedBound bound(*c.V, c.problem, levels, level);
      const auto eta = bound(c.iterate());
      EXPECT_LE(eta.total, (1 + 1e-12) * (eta.discretization + eta.linearization + eta.algebraic)) << named(setting);
      for (int alpha = 0; alpha < count; ++alpha) {
        const Errors e = errors(bound, alpha);
        EXPECT_LE(e.worst(), 1e-10) << named(setting) << (varying ? ", varying tensions" : "") << (neumann ? ", Neumann data" : "")
                                    << ", membrane " << alpha + 1 << " of " << count << ": total " << e.total << ", lin " << e.linearization
                                    << ", alg " << e.algebraic << ", jump " << e.jump;
      }
    }
}

/// What one membrane gains the other one loses.
TEST_P(Bound, takes_the_sum_of_the_forces_whatever_the_multiplier_is) {
  for (const auto& setting : settings()) {
    const auto c = arbitrary(setting, false, true, 2);
    GuaranteedBound bound(*c.V, c.problem, levels, level);
    bound(c.iterate());
    const int q = bound.flux_degree();
    const ConstCellTable upper = bound.fluxes(0).density, lower = bound.fluxes(1).density, f1 = density_of(mesh, force(0), q),
                         f2 = density_of(mesh, force(1), q);
    double worst = 0, size = 0;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int m = 0; m < f1.extent_int(1); ++m) {
        worst = std::max(worst, std::abs(upper(K, m) + lower(K, m) - f1(K, m) - f2(K, m)));
        size = std::max(size, std::abs(f1(K, m)));
      }
    EXPECT_LE(mesh.comm.max(worst), 1e-12 * mesh.comm.max(size)) << named(setting);
  }
}

/// The density of membrane 1 minus that without a multiplier.
TEST_P(Bound, has_a_multiplier_that_is_nowhere_negative) {
  for (const auto& setting : settings()) {
    if (setting.name != MethodName::fem) continue;
    const auto c = arbitrary(setting, false, true, 2);
    auto none = arbitrary(setting, false, true, 2, -10);
    GuaranteedBound bound(*c.V, c.problem, levels, level), without(*none.V, none.problem, levels, level);
    bound(c.iterate());
    without(none.iterate());
    const auto with_it = bound.fluxes(0).density, force = without.fluxes(0).density;
    const CellTable lambda("lambda", with_it.extent(0), with_it.extent(1));
    double size = 0;
    for (std::size_t K = 0; K < lambda.extent(0); ++K)
      for (int m = 0; m < lambda.extent_int(1); ++m) {
        lambda(K, m) = with_it(K, m) - force(K, m);
        size = std::max(size, std::abs(lambda(K, m)));
      }
    EXPECT_GT(mesh.comm.max(size), 1e-6) << named(setting);
    EXPECT_GE(least(lambda, bound.flux_degree()), -1e-12) << named(setting);
  }
}

/// What is wrong with the data shows: a residual that is not that of the iterate, another multiplier, another field.
TEST_P(Bound, does_not_balance_data_that_do_not_belong_together) {
  for (const auto& setting : settings()) {
    for (int what = 0; what < 2; ++what) {
      auto c = arbitrary(setting, false, false, 2);
      GuaranteedBound bound(*c.V, c.problem, levels, level);
      bound(c.iterate());
      const double right = std::max(errors(bound, 0).worst(), errors(bound, 1).worst());
      {
        auto& wrong = what == 0 ? *c.residual[0] : *c.lambda;
        const auto values = algebra::host_view(wrong);
        for (std::size_t l = 0; l < values.extent(0); ++l) values(l) += 0.1 * (1 + std::abs(values(l)));
      }
      bound(c.iterate());
      EXPECT_LT(right, 1e-10) << named(setting);
      EXPECT_GT(std::max(errors(bound, 0).worst(), errors(bound, 1).worst()), 1e-5) << named(setting) << ", " << what;
    }
  }
}

std::string underscored(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name)
    if (letter == ' ' || letter == '-') letter = '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(Meshes, Bound,
                         ::testing::Values("criss-cross", "disk", "file", "refined file", "adaptive square", "adaptive disk"), underscored);

}  // namespace
}  // namespace thixis::equilibration
