/// The feasible pair where the multiplier presses on gaps that contact leaves open.
#include "feasible_setting.hpp"
#include "lift/continuous_nodes.hpp"

namespace thixis::bound {
namespace {

using Gaps = FeasiblePair::Gaps;

/// |||s - u_h|||² and 2 (lambda, s_1 - s_2) over all cells.
struct Price {
  double energy, contact;
  bool at_points;
  double sum() const { return energy + contact; }
};
Price price(const FeasiblePair& s, const Coefficients (&u)[2], const CellTable& lambda, int degree, Gaps gaps, const core::Comm& comm) {
  FeasiblePair::Parts parts;
  s.evaluate(u, lambda, degree, parts, 0, gaps);
  return {sum_of(comm, parts.whole, 2), 2 * sum_of(comm, parts.contact), comm.any(parts.at_points)};
}

bool is_inside(const std::array<double, 2>& x) { return std::min({x[0], 1 - x[0], x[1], 1 - x[1]}) > 1e-9; }

/// Quadratic functions that are `height` at the vertices inside of the square, `between` half the way between them, and 0 on the boundary.
Coefficients at_vertices(const Space& V, double height, double between = 0) {
  const Coefficients u = interpolated(V, scene::constant(0));
  const auto& entries = V.coefficients().element_entries;
  const int first = V.basis().interior();
  for (std::size_t k = 0; k < V.cells().extent(0); ++k)
    for (int l = 0; l < V.basis().size(); ++l)
      if (is_inside(V.coefficients().entries.point[entries(k, l)])) u(entries(k, l)) = l >= first && l < first + 3 ? height : between;
  return u;
}

class Pressed : public ::testing::TestWithParam<std::string> {
 protected:
  mesh::Hierarchy levels = square(1);
  const mesh::Mesh& mesh = levels.finest();
  std::unique_ptr<Space> V = make_space(mesh, {GetParam(), 2});
  const FieldPtr zero = scene::constant(0);
  const FeasiblePair s{*V, two_membranes(mesh, zero, zero, scene::constant(1), scene::constant(3))};
  Coefficients lower = interpolated(*V, zero);
};

}  // namespace

TEST_P(Pressed, gaps_at_vertices_are_closed_where_the_multiplier_can_close_them) {
  const double height = 1e-3;
  const Coefficients u[2] = {at_vertices(*V, height, -height / 16), lower};
  const auto lambda = density_of(mesh, scene::constant(50), 0);
  const Price kept = price(s, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(s, u, lambda, 0, Gaps::pressed, mesh.comm);
  // what is open at vertices and what is below zero between them: mu_1 mu_2/(mu_1 + mu_2) |grad (u_1 - u_2)|²
  double energy = 0;
  Sampler sample(*V);
  at_points(mesh, 2, [&](double weight, const PointOfCell& at) {
    sample.at(at);
    const Sample slope = sample(sample.coefficients(u[0], at.cell));
    for (const double component : slope.gradient) energy += 0.75 * weight * component * component;
  });
  energy = mesh.comm.sum(energy);
  EXPECT_GT(kept.contact, 1e-4);
  EXPECT_NEAR(pressed.energy, energy, 1e-9 * energy);
  EXPECT_LT(pressed.contact, 1e-12);
  EXPECT_FALSE(pressed.at_points);
}

TEST_P(Pressed, the_sum_is_never_more_than_with_gaps_that_are_kept_and_the_same_without_a_multiplier) {
  for (const double height : {1e-4, 1e-3, 1e-2, 1.0}) {
    const Coefficients u[2] = {at_vertices(*V, height), lower};
    for (const double pressure : {0.0, 0.01, 1.0, 100.0}) {
      const auto lambda = density_of(mesh, scene::constant(pressure), 0);
      const Price kept = price(s, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(s, u, lambda, 0, Gaps::pressed, mesh.comm);
      if (pressure == 0) {
        EXPECT_EQ(kept.energy, pressed.energy);
        EXPECT_EQ(pressed.contact, 0);
      } else {
        EXPECT_LE(pressed.sum(), kept.sum() * (1 + 1e-12)) << height << ", " << pressure;
        EXPECT_LE(pressed.contact, kept.contact) << height << ", " << pressure;
      }
    }
  }
}

/// On the boundary the upper membrane is held as the functions of vertices are, and no multiplier closes its gaps there.
TEST_P(Pressed, gaps_of_the_data_stay_as_they_are) {
  const auto arcs = [](double x) { return std::pow(1 - 2 * (8 * x - std::floor(8 * x)), 2); };
  const auto g = scene::formula([arcs](double x, double y) { return 1e-3 * arcs(x) * arcs(y); });
  const FeasiblePair held(*V, two_membranes(mesh, g, zero, scene::constant(1), scene::constant(3)));
  ASSERT_EQ(held.boundary_energy(), 0);
  const Coefficients u[2] = {interpolated(*V, zero, g), lower};
  const auto lambda = density_of(mesh, scene::constant(1e6), 0);
  const Price kept = price(held, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(held, u, lambda, 0, Gaps::pressed, mesh.comm);
  EXPECT_GT(kept.contact, 1);
  EXPECT_EQ(pressed.energy, kept.energy);
  EXPECT_EQ(pressed.contact, kept.contact);
}

TEST_P(Pressed, gaps_of_membranes_that_come_apart_are_kept) {
  const auto bump = scene::formula([](double x, double y) { return 1e-4 * x * (1 - x) * y * (1 - y); });
  const Coefficients u[2] = {interpolated(*V, bump, zero), lower};
  const auto lambda = density_of(mesh, scene::constant(50), 0);
  const Price kept = price(s, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(s, u, lambda, 0, Gaps::pressed, mesh.comm);
  EXPECT_EQ(pressed.energy, kept.energy);
  EXPECT_EQ(pressed.contact, kept.contact);
}

INSTANTIATE_TEST_SUITE_P(Methods, Pressed, ::testing::ValuesIn(tests::built({"fem", "dg", "hho"})));

namespace {

double height(double x, double y) { return 0.3 * std::sin(x + 2 * y) + 0.2 * x * x * x * x * x; }

/// |||psi - psi_I|||², psi_I the interpolant.
double energy_of_interpolation(const Space& V, const Coefficients& psi) {
  Sampler sample(V);
  double sum = 0;
  at_points(V.mesh(), 20, [&](double weight, const PointOfCell& at) {
    sample.at(at);
    const Sample slope = sample(sample.coefficients(psi, at.cell));
    const double wave = 0.3 * std::cos(at.x + 2 * at.y);
    sum += weight * (std::pow(wave + std::pow(at.x, 4) - slope.gradient[0], 2) + std::pow(2 * wave - slope.gradient[1], 2));
  });
  return V.mesh().comm.sum(sum);
}

}  // namespace

/// u_h is the interpolant of the obstacle. s that lies on psi itself costs |||psi - psi_I|||, on the held boundary, too, where g = psi.
TEST(PressedObstacle, a_curved_one_is_followed_up_to_the_held_boundary) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto psi = scene::formula(height);
  for (const auto& name : tests::built({"fem", "hho"}))
    for (int p = 1; p <= 4; ++p) {
      const auto V = make_space(mesh, {name, p});
      const FeasiblePair s(*V, {1, {scene::constant(1), nullptr}, {everywhere(mesh, psi), {}}, psi});
      const Coefficients u[2] = {interpolated(*V, psi), {}};
      const auto lambda = density_of(mesh, scene::constant(1e4), 0);
      const Price kept = price(s, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(s, u, lambda, 0, Gaps::pressed, mesh.comm);
      const double energy = energy_of_interpolation(*V, u[0]), lift = s.boundary_energy();
      EXPECT_GT(kept.contact, 100 * energy) << p;
      EXPECT_LT(pressed.contact, 1e-9 * kept.contact) << p;
      // two pieces, by the triangle inequality: the lift, and what takes it to psi - psi_I
      EXPECT_GT(pressed.energy, 0.999 * energy) << p;
      EXPECT_LT(pressed.energy, 1.001 * std::pow(2 * lift + std::sqrt(energy), 2)) << p;
    }
}

namespace {

/// Zero at vertices of the square(1), and half the way between them.
double between_nodes(double x) {
  const double t = 8 * x - std::floor(8 * x);
  return t * (1 - t) * std::pow(1 - 2 * t, 2);
}

/// The sums over all ranks of what cells add to vertices, by global id.
using OfVertices = std::vector<double>;

}  // namespace

/// Gaps that only the data have: none of the nodes sees them, s has to open on the held boundary all the same, and closes in the next row.
TEST(PressedData, that_come_apart_between_nodes_are_kept_on_the_held_boundary) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto g = scene::formula([](double x, double y) { return 0.1 * (between_nodes(x) + between_nodes(y)); });
  const auto zero = scene::constant(0), one = scene::constant(1);
  for (int p = 1; p <= 2; ++p) {
    const auto V = make_space(mesh, {"fem", p});
    const Coefficients u[2] = {interpolated(*V, zero), interpolated(*V, zero)};
    const auto lambda = density_of(mesh, scene::constant(1e6), 0);
    for (const auto& problem :
         {two_membranes(mesh, g, zero, one, one), FeasiblePair::Problem{1, {one, nullptr}, {everywhere(mesh, g), {}}, zero}}) {
      const FeasiblePair s(*V, problem);
      const Price kept = price(s, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(s, u, lambda, 0, Gaps::pressed, mesh.comm);
      EXPECT_TRUE(kept.at_points && pressed.at_points) << p;
      EXPECT_GT(pressed.contact, 0.1 * kept.contact) << p;
      EXPECT_LT(pressed.contact, 0.5 * kept.contact) << p;
    }
  }
}

/// Where membranes are apart by more than the data deviate nothing is followed: no integral has to be taken at points for that.
TEST(PressedData, far_from_each_other_are_not_followed) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto g = scene::formula([](double x, double y) { return 1 + between_nodes(x) + between_nodes(y); });
  const auto zero = scene::constant(0), one = scene::constant(1);
  const auto V = make_space(mesh, {"fem", 2});
  const FeasiblePair s(*V, two_membranes(mesh, g, zero, one, one));
  EXPECT_GT(s.boundary_energy(), 0.1);
  const Coefficients u[2] = {interpolated(*V, one), interpolated(*V, zero)};
  const auto lambda = density_of(mesh, one, 0);
  const Price kept = price(s, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(s, u, lambda, 0, Gaps::pressed, mesh.comm);
  EXPECT_FALSE(kept.at_points || pressed.at_points);
  EXPECT_EQ(pressed.energy, kept.energy);
  EXPECT_EQ(pressed.contact, kept.contact);
}

/// The linear interpolant of a convex obstacle lies above it: s = psi_I - chi D, by the formulas.
TEST(PressedObstacle, is_followed_in_part_where_that_is_the_least) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto host = mesh::on_host(mesh);
  const auto V = make_space(mesh, {"fem", 1});
  const auto convex = [](double x, double y) { return 0.5 * x * x + 0.2 * x * y + 0.4 * y * y; };
  const auto psi = scene::formula(convex), above = scene::constant(2);
  const double mu = 2;
  const FeasiblePair s(*V, {1, {scene::constant(mu), nullptr}, {everywhere(mesh, above), {}}, psi});
  const Coefficients u[2] = {interpolated(*V, psi, above), {}}, psi_I = interpolated(*V, psi);
  Sampler sample(*V);
  const auto deviation = [&](const PointOfCell& at) {
    sample.at(at);
    Sample D = sample(sample.coefficients(psi_I, at.cell));
    D.value -= convex(at.x, at.y);
    D.gradient[0] -= at.x + 0.2 * at.y;
    D.gradient[1] -= 0.2 * at.x + 0.8 * at.y;
    return D;
  };
  for (const double pressure : {1.0, 5.0, 20.0}) {
    const auto force = scene::formula([pressure](double x, double) { return pressure * (x < 0.5 ? 1 : 2); });
    OfVertices gain(mesh.global_vertices, 0), cost = gain;
    at_points(mesh, 6, [&](double weight, const PointOfCell& at) {
      const Sample D = deviation(at);
      double load = 0;
      force->evaluate({1, &at.x, &at.y}, 0, &load);
      for (int i = 0; i < 3; ++i) {
        const GlobalIndex v = mesh.vertex_id[host.cell_vertices(at.cell, i)];
        gain[v] += weight * load * D.value;
        cost[v] += weight * mu * (D.gradient[0] * D.gradient[0] + D.gradient[1] * D.gradient[1]);
      }
    });
    mesh.comm.sum(gain);
    mesh.comm.sum(cost);
    const auto chi = [&](LocalIndex v) {
      const double x = host.coordinates(v, 0), y = host.coordinates(v, 1);
      const bool held = x < 1e-9 || x > 1 - 1e-9 || y < 1e-9 || y > 1 - 1e-9;
      return held ? 0.0 : std::min(1.0, gain[mesh.vertex_id[v]] / cost[mesh.vertex_id[v]]);
    };
    double energy = 0, contact = 0, largest = 0;
    at_points(mesh, 6, [&](double weight, const PointOfCell& at) {
      const auto K = mesh::cell_geometry(host.coordinates, host.cell_vertices, at.cell);
      const double lambda[3] = {1 - at.xi - at.eta, at.xi, at.eta};
      double part = 0, slope[2] = {0, 0}, load = 0;
      for (int a = 0; a < 3; ++a) {
        const double of_vertex = chi(host.cell_vertices(at.cell, a));
        part += lambda[a] * of_vertex;
        for (int d = 0; d < 2; ++d) slope[d] += of_vertex * K.gradient[a][d];
      }
      const Sample D = deviation(at);
      force->evaluate({1, &at.x, &at.y}, 0, &load);
      for (int d = 0; d < 2; ++d) energy += weight * mu * std::pow(part * D.gradient[d] + slope[d] * D.value, 2);
      contact += weight * 2 * load * (sample(sample.coefficients(u[0], at.cell)).value - convex(at.x, at.y) - part * D.value);
      largest = std::max(largest, part);
    });
    energy = mesh.comm.sum(energy);
    contact = mesh.comm.sum(contact);
    largest = mesh.comm.max(largest);
    EXPECT_GT(largest, 0.1);
    const Price pressed = price(s, u, density_of(mesh, force, 0), 0, Gaps::pressed, mesh.comm);
    EXPECT_NEAR(pressed.energy, energy, 1e-6 * energy) << pressure << ", " << largest;
    EXPECT_NEAR(pressed.contact, contact, 1e-8 * contact) << pressure << ", " << largest;
  }
}

/// Data above the obstacle that are no polynomials hold s where they are: there psi is not followed.
TEST(PressedObstacle, data_above_it_are_kept_on_the_held_boundary) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto psi = scene::formula(height);
  const auto V = make_space(mesh, {"fem", 3});
  for (const double above : {0.0, 1.0}) {
    const auto g = scene::formula([above](double x, double y) { return height(x, y) + above * (1 + std::cosh(x - y)); });
    const FeasiblePair s(*V, {1, {scene::constant(1), nullptr}, {everywhere(mesh, g), {}}, psi});
    const Coefficients u[2] = {interpolated(*V, psi, g), {}};
    const Price pressed = price(s, u, density_of(mesh, scene::constant(1e4), 0), 0, Gaps::pressed, mesh.comm);
    if (above == 0) {
      EXPECT_LT(pressed.contact, 1e-9);
    } else {
      EXPECT_GT(pressed.contact, 1);
    }
  }
}

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
