/// The multiplier of the bound next to the held boundary, where no moments are known.
#include <random>

#include "bound_setting.hpp"
#include "multiplier/held_moments.hpp"
#include "multiplier/multiplier.hpp"

namespace thixis::bound {
namespace {

/// Cells in every corner: the diagonals leave single ones in two of them.
mesh::Hierarchy diagonals() {
  mesh::MeshParams params;
  params.generator = mesh::Generator::rectangle;
  params.cells_per_side = 3;
  params.cells_per_rank = 4;
  return mesh::build(params, core::Comm(), "");
}

/// Of degree p - 1, positive, and steep enough to tell a reflected one from it.
FieldPtr pressure(int p) {
  return scene::formula(
      [p](double x, double y) { return p == 1 ? 4 : 4 + x - 0.7 * y + (p > 2 ? 0.5 * x * y - y * y : 0) + (p > 3 ? x * x * y : 0); });
}

/// D_l X3_l of a multiplier.
algebra::Vector moments_of(const Space& V, const FieldPtr& lambda) {
  algebra::Vector X3(V.points());
  V.interpolate_multiplier(*lambda, 0, X3);
  const auto values = algebra::host_view(X3);
  const auto D = algebra::host_view(V.pairing());
  for (std::size_t l = 0; l < values.extent(0); ++l) values(l) *= D(l);
  return X3;
}

void expect_reproduced(const mesh::Mesh& mesh, const Setting& setting, const std::string& where) {
  const auto V = make_space(mesh, setting);
  const int p = setting.degree, modes = reference::dimension(p);
  const auto fit = patchwise_multiplier(*V, {});
  const CellTable lambda("lambda", mesh.owned_cells, modes), patches("patches", V->cells().extent(0), 3 * modes);
  (*fit)(moments_of(*V, pressure(p)), lambda, patches);
  const auto expected = density_of(mesh, pressure(p), p);
  double error = 0, size = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int m = 0; m < modes; ++m) {
      error = std::max(error, std::abs(lambda(K, m) - expected(K, m)));
      size = std::max(size, std::abs(expected(K, m)));
    }
  EXPECT_LT(error, 1e-9 * size) << where << ", degree " << p;
}

}  // namespace

/// Patches of held vertices take what functions inside of them say, those in corners what their neighbours continue.
TEST(PatchwiseMultiplier, reproduces_polynomials_of_degree_p_less_1_up_to_the_held_boundary) {
  for (const Nodes family : {Nodes::gauss_lobatto, Nodes::bernstein})
    for (int p = 1; p <= 4; ++p) {
      expect_reproduced(square(0).finest(), {"fem", p, family}, "square");
      expect_reproduced(diagonals().finest(), {"fem", p, family}, "corners of one cell");
    }
}

namespace {

/// dG with strong data, where functions of the boundary are held.
std::unique_ptr<Space> strong(const mesh::Mesh& mesh, int p) {
  method::MethodParams params;
  params.name = "dg";
  params.degree = p;
  params = tests::with(params, {{"boundary", "strong"}});
  return tests::method_of("dg").make_space(mesh, {std::vector<bool>(mesh.tags.size(), true), nullptr, params});
}

/// (lambda, psi_l)_K at the entries of a broken space.
View<double*> moments_by_entry(const Space& V, const FieldPtr& lambda) {
  const auto& entries = V.coefficients().element_entries;
  const auto host = mesh::on_host(V.mesh());
  const auto rule = reference::triangle_quadrature(10);
  const auto psi = V.basis().tabulate(rule.size(), rule.point.data()).value;
  const int n = V.basis().size();
  const View<double*> moments("moments", V.coefficients().entries.size());
  for (std::size_t k = 0; k < V.cells().extent(0); ++k)
    for (int q = 0; q < rule.size(); ++q) {
      const double xi = rule.point[2 * q], eta = rule.point[2 * q + 1], b[3] = {1 - xi - eta, xi, eta};
      double x = 0, y = 0, value = 0;
      for (int a = 0; a < 3; ++a) {
        x += b[a] * host.coordinates(host.cell_vertices(V.cells()(k), a), 0);
        y += b[a] * host.coordinates(host.cell_vertices(V.cells()(k), a), 1);
      }
      lambda->evaluate({1, &x, &y}, 0, &value);
      const double weight = 2 * mesh::cell_area(host.coordinates, host.cell_vertices, V.cells()(k)) * rule.weight[q];
      for (int l = 0; l < n; ++l) moments(entries(k, l)) += weight * value * psi[q * n + l];
    }
  return moments;
}

}  // namespace

TEST(HeldMoments, are_those_of_a_polynomial_of_degree_p_less_1) {
  SKIP_UNLESS_BUILT("dg");
  const auto levels = square(0);
  const auto& mesh = levels.finest();
  for (int p = 2; p <= 4; ++p) {
    const auto V = strong(mesh, p);
    const auto all = moments_by_entry(*V, pressure(p));
    const View<double*> free("free", all.extent(0));
    const auto is_held = [&](LocalIndex e) { return V->numbering().held[e] >= 0; };
    for (std::size_t e = 0; e < all.extent(0); ++e) free(e) = is_held(static_cast<LocalIndex>(e)) ? 0 : all(e);
    const HeldMoments held(*V);
    held(free);
    int seen = 0;
    for (std::size_t k = 0; k < V->cells().extent(0) && held.of_cells().extent(0) > 0; ++k)
      for (int l = 0; l < V->basis().size(); ++l) {
        const LocalIndex e = V->coefficients().element_entries(k, l);
        EXPECT_NEAR(held.of_cells()(k, l), is_held(e) ? all(e) : 0, 1e-11) << p;
        seen += is_held(e) ? 1 : 0;
      }
    EXPECT_GT(mesh.comm.sum(static_cast<long long>(seen)), 0);
  }
}

TEST(HeldMoments, leave_every_cell_a_mean_that_is_not_negative) {
  SKIP_UNLESS_BUILT("dg");
  const auto levels = diagonals();
  const auto& mesh = levels.finest();
  std::mt19937 engine(3);
  for (int p = 1; p <= 4; ++p) {
    const auto V = strong(mesh, p);
    const HeldMoments held(*V);
    for (int trial = 0; trial < 20; ++trial) {
      const View<double*> free("free", V->coefficients().entries.size());
      for (std::size_t e = 0; e < free.extent(0); ++e)
        if (V->numbering().held[e] < 0) free(e) = std::pow(std::uniform_real_distribution<double>(0, 1)(engine), 4);
      held(free);
      for (std::size_t k = 0; k < held.of_cells().extent(0); ++k) {
        double sum = 0;
        for (int l = 0; l < V->basis().size(); ++l) sum += held.of_cells()(k, l) + free(V->coefficients().element_entries(k, l));
        EXPECT_GE(sum, -1e-12) << p;
      }
    }
  }
}

}  // namespace thixis::bound
