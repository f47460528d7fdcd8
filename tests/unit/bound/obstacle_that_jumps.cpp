/// The feasible function over an obstacle that jumps inside of cells.
#include "lift/continuous_nodes.hpp"
#include "pressed_setting.hpp"

namespace thixis::bound {
namespace {

/// 0.2 where x < 0.31, else -0.4: the edge passes through cells.
double step(double x, double /*y*/) { return x < 0.31 ? 0.2 : -0.4; }

}  // namespace

/// The contact term is that of s and psi: gap to the majorant and what this has above psi together.
TEST(ObstacleThatJumps, the_contact_term_counts_the_whole_gap) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  for (int p = 1; p <= 4; ++p) {
    const auto V = make_space(mesh, {"fem", p});
    const auto one = scene::constant(1);
    const FeasiblePair s(*V, {1, {one, nullptr}, {everywhere(mesh, one), {}}, scene::formula(step)});
    FeasiblePair::Parts parts;
    s.evaluate({interpolated(*V, one), {}}, density_of(mesh, one, 0), 0, parts);
    double gap = 0;
    method::for_each_block(V->quadrature(), [&](const method::QuadratureBlock& block) {
      for (LocalIndex k = 0; k < block.cells; ++k)
        for (int q = block.offset(k); q < block.offset(k + 1) && block.cell(k) < mesh.owned_cells; ++q)
          gap += block.weight(q) * (1 - step(block.x(q), block.y(q)));
    });
    EXPECT_NEAR(sum_of(mesh.comm, parts.contact), mesh.comm.sum(gap), 1e-9) << p;
    EXPECT_LT(sum_of(mesh.comm, parts.whole), 1e-12) << p;
    EXPECT_FALSE(s.obstacle_is_interpolated());
    EXPECT_TRUE(mesh.comm.any(s.jumps().extent(0) > 0));
  }
}

/// s lies on the majorant in cells in which the obstacle jumps: the cells beside them follow it from the vertex beyond, if at all.
TEST(ObstacleThatJumps, it_is_not_followed_at_its_edge) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto host = mesh::on_host(mesh);
  const auto V = make_space(mesh, {"fem", 1});
  const auto psi = scene::formula([](double x, double y) { return step(x, y) + 0.5 * x * x + 0.4 * y * y; });
  const auto one = scene::constant(1);
  const FeasiblePair s(*V, {1, {one, nullptr}, {everywhere(mesh, one), {}}, psi});
  const Coefficients u[2] = {interpolated(*V, psi, one), {}};
  const auto jumps = s.jumps();
  std::vector<double> at_edge(mesh.global_vertices, 0);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3 && jumps(K); ++i) at_edge[mesh.vertex_id[host.cell_vertices(K, i)]] = 1;
  mesh.comm.max(at_edge);
  const auto lambda = density_of(mesh, scene::constant(1e6), 0);
  FeasiblePair::Parts kept, pressed;
  s.evaluate(u, lambda, 0, kept, 0, Gaps::kept);
  s.evaluate(u, lambda, 0, pressed, 0, Gaps::pressed);
  int beside = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    int corners = 0;
    for (int i = 0; i < 3; ++i) corners += at_edge[mesh.vertex_id[host.cell_vertices(K, i)]] > 0 ? 1 : 0;
    if (jumps(K) || corners < 2 || kept.contact(K) == 0) continue;
    ++beside;
    EXPECT_GT(pressed.contact(K), 0.5 * kept.contact(K)) << mesh.cell_id[K];
  }
  EXPECT_GT(mesh.comm.sum(static_cast<long long>(beside)), 8);
}

TEST(ObstacleThatJumps, the_majorant_is_nowhere_below_it_and_contact_points_stay_in_its_range) {
  SKIP_UNLESS_BUILT("dg");
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto psi = scene::formula(step);
  for (const Nodes family : {Nodes::gauss_lobatto, Nodes::bernstein})
    for (int p = 2; p <= 4; ++p) {
      const auto V = make_space(mesh, {"dg", p, family});
      const auto nodes = continuous_nodes(mesh, V->cells(), V->basis(), V->basis().points(), std::vector<bool>(mesh.tags.size(), true));
      const auto jumps = mesh.comm.together([&] { return method::jumps_in_cells(V->quadrature(), *psi, 0); });
      const auto I = obstacle_coefficients(*V, nodes, *psi, jumps);
      for (const double value : I) EXPECT_TRUE(value >= -0.4 - 1e-12 && value <= 0.2 + 1e-12) << value;
      const auto above = majorant(*V, nodes, jumps, I, std::vector<double>(I.size(), 1));
      if (above.empty()) continue;
      Sampler sample(*V);
      densely(mesh, 10, [&](double, const PointOfCell& at) {
        std::vector<double> c(V->basis().size());
        for (std::size_t l = 0; l < c.size(); ++l) c[l] = above[nodes.of_cells(at.cell, l)];
        sample.at(at);
        if (jumps.at(at.cell)) {
          EXPECT_GE(sample(c).value, step(at.x, at.y) - 1e-12) << at.x;
        }
      });
    }
}

}  // namespace thixis::bound
