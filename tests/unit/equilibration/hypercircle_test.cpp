/// Fluxes on patches bound the error of the finite element solution of -Lap u = f, and closely.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "patch_data.hpp"
#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/fem/forms.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/method/form.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::equilibration {
namespace {

constexpr double pi = 3.14159265358979323846;

/// u = sin(pi x) (y² + cosh y) on the unit square, 0 at the left and on the right; with its slopes below and above.
struct Problem {
  static double u(double x, double y) { return std::sin(pi * x) * (y * y + std::cosh(y)); }
  static double f(double x, double y) { return pi * pi * u(x, y) - std::sin(pi * x) * (2 + std::cosh(y)); }
  static double slope_x(double x, double y) { return pi * std::cos(pi * x) * (y * y + std::cosh(y)); }
  static double slope_y(double x, double y) { return std::sin(pi * x) * (2 * y + std::sinh(y)); }  ///< 0 at y = 0
};

class Hypercircle : public testing::TestWithParam<int> {
 protected:
  const int p = GetParam(), n = reference::dimension(p), N = reference::dimension(p + 1);

  struct Figures {
    double error, bound;
  };
  Figures figures(int refinements) const {
    const auto levels = hierarchy("criss-cross", refinements);
    const mesh::Mesh& mesh = levels.finest();
    const auto held = held_tags(mesh, Held::some);
    method::MethodParams params;
    params.degree = p;
    params.quadrature_order = 2 * p + 8;
    const auto space = fem::make_lagrange_space(mesh, {held, nullptr, params});
    const auto& V = *space;
    const auto u = solution(V, held);

    const auto& cells = V.cells();
    const PatchData data = {CellTable("density", cells.extent(0), 3 * n), CellTable("target", cells.extent(0), 2 * n),
                            CellTable("traction", mesh.faces, 2 * (p + 1))};
    const auto oscillation = fill(V, u, data);
    fill_tractions(mesh, held, data.traction);
    const CellTable sigma("sigma", mesh.owned_cells, 2 * N);
    PatchFlux(mesh, cells, held, p)(data.data(), sigma);

    const auto metric = metrics(mesh, cells);
    double bound = 0;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
      for (int d = 0; d < 2; ++d)
        for (int l = 0; l < n; ++l) sigma(K, d * N + l) -= data.target(K, d * n + l);
      bound += std::pow(std::sqrt(metric(K).square(&sigma(K, 0), &sigma(K, N), N)) + oscillation[K], 2);
    }
    const method::Gradient gradient = {scene::formula(Problem::slope_x), scene::formula(Problem::slope_y)};
    return {std::sqrt(method::energy_error(*fem::diffusion(V, scene::constant(1)), u, {method::Known{gradient}}, 0)),
            std::sqrt(mesh.comm.sum(bound))};
  }

  method::Coefficients solution(const method::Space& V, const std::vector<bool>& held) const {
    method::BoundaryValues boundary;
    for (const bool h : held) {
      boundary.dirichlet.push_back(h ? scene::formula(Problem::u) : nullptr);
      boundary.neumann.push_back(h ? nullptr : scene::formula([](double x, double y) { return y > 0.5 ? Problem::slope_y(x, y) : 0.0; }));
    }
    const auto tension = scene::constant(1);
    const auto S = method::assemble(*fem::diffusion(V, tension));
    algebra::Vector F(V.map()), x(V.map()), exerted(V.map());
    method::load(*fem::diffusion(V, tension), *scene::formula(Problem::f), boundary, 0, F);
    const auto lift = V.lift(boundary, 0);
    method::apply(*fem::diffusion(V, tension), V.complete(x, lift), exerted);
    F.update(-1, exerted, 1);
    algebra::LinearParams params;
    params.solver = algebra::SolverKind::direct;
    algebra::Solver solver(params);
    solver.set_matrix(S, 1, {V.coordinates(), {}});
    EXPECT_LT(solver.solve(F, x, {1e-13 * F.norm2(), 0, nullptr}).residual, 1e-10 * F.norm2());
    return V.complete(x, lift);
  }

  /// w = -grad u_h, g_a = psi_a f + w·grad psi_a; returns (h_K/pi) |f - its projection| for each cell.
  std::vector<double> fill(const method::Space& V, const method::Coefficients& u, const PatchData& data) const {
    const mesh::Mesh& mesh = V.mesh();
    const auto host = mesh::on_host(mesh);
    const auto metric = metrics(mesh, V.cells());
    const auto rule = reference::triangle_quadrature(2 * p + 8);
    const auto phi = reference::Modal(p).values(rule.size(), rule.point.data());
    const auto psi = V.basis().tabulate(rule.size(), rule.point.data());
    const double slope_of_hat[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
    std::vector<double> oscillation;
    for (LocalIndex k = 0; k < V.cells().extent_int(0); ++k) {
      const LocalIndex K = V.cells()(k);
      const Metric G = metric(k);
      double x[3][2], square = 0;
      std::vector<double> moments(n, 0.0);
      for (int i = 0; i < 3; ++i)
        for (int d = 0; d < 2; ++d) x[i][d] = host.coordinates(host.cell_vertices(K, i), d);
      for (int at = 0; at < rule.size(); ++at) {
        const double *xi = &rule.point[2 * at], lambda[3] = {1 - xi[0] - xi[1], xi[0], xi[1]}, weight = rule.weight[at];
        double slope[2] = {0, 0}, place[2] = {0, 0};
        for (int l = 0; l < n; ++l)
          for (int d = 0; d < 2; ++d) slope[d] += u(V.coefficients().element_entries(k, l)) * psi.gradient[2 * (at * n + l) + d];
        for (int i = 0; i < 3; ++i)
          for (int d = 0; d < 2; ++d) place[d] += lambda[i] * x[i][d];
        const double w[2] = {-G.G11 * slope[0] + G.G01 * slope[1], G.G01 * slope[0] - G.G00 * slope[1]};
        const double f = G.det * Problem::f(place[0], place[1]);
        square += weight * f * f / G.det;
        for (int l = 0; l < n; ++l) {
          const double tested = weight * phi[at * n + l];
          moments[l] += tested * f;
          for (int d = 0; d < 2; ++d) data.target(k, d * n + l) += tested * w[d];
          for (int i = 0; i < 3; ++i)
            data.density(k, i * n + l) += tested * (lambda[i] * f + w[0] * slope_of_hat[i][0] + w[1] * slope_of_hat[i][1]);
        }
      }
      for (const double m : moments) square -= m * m / G.det;
      double h = 0;
      for (int i = 0; i < 3; ++i) h = std::max(h, std::hypot(x[i][0] - x[(i + 1) % 3][0], x[i][1] - x[(i + 1) % 3][1]));
      oscillation.push_back(h / pi * std::sqrt(std::max(square, 0.0)));
    }
    return oscillation;
  }

  /// sigma_a·n = -psi_a du/dn.
  void fill_tractions(const mesh::Mesh& mesh, const std::vector<bool>& held, const CellTable& traction) const {
    const auto host = mesh::on_host(mesh);
    const auto rule = reference::line_quadrature(2 * p + 8);
    for (LocalIndex F = 0; F < mesh.faces; ++F) {
      if (host.face_tag(F) < 0 || held[host.face_tag(F)]) continue;
      const LocalIndex a = host.face_vertices(F, 0), b = host.face_vertices(F, 1);
      const double length = std::abs(host.coordinates(b, 0) - host.coordinates(a, 0)), y = host.coordinates(a, 1);
      for (int at = 0; at < rule.size(); ++at) {
        const double s = rule.point[at], x = (1 - s) * host.coordinates(a, 0) + s * host.coordinates(b, 0);
        const auto L = reference::legendre(p + 1, s);
        const double t = rule.weight[at] * length * (y > 0.5 ? Problem::slope_y(x, y) : 0);
        for (int j = 0; j <= p; ++j) {
          traction(F, j) -= (1 - s) * t * L[j];
          traction(F, p + 1 + j) -= s * t * L[j];
        }
      }
    }
  }
};

/// |grad(u - u_h)| <= { sum_K (|grad u_h + sigma|_K + (h_K/pi) |f - Pi f|_K)² }^{1/2}; the slopes on the boundary are integrated to 1e-9.
TEST_P(Hypercircle, bounds_the_error_closely) {
  for (int refinements = 1; refinements <= 2; ++refinements) {
    const auto [error, bound] = figures(refinements);
    EXPECT_GT(bound, error);
    EXPECT_LT(bound, 1.1 * error);
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, Hypercircle, testing::Values(1, 2, 3, 4));

}  // namespace
}  // namespace thixis::equilibration
