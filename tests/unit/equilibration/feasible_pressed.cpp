/// The feasible pair where the multiplier presses on gaps that contact leaves open.
#include "continuous_nodes.hpp"
#include "feasible_setting.hpp"

namespace thixis::equilibration {
namespace {

using Gaps = FeasiblePair::Gaps;

/// |||s - u_h|||² and 2 (lambda, s_1 - s_2) over all cells.
struct Price {
  double energy, contact;
  double sum() const { return energy + contact; }
};
Price price(const FeasiblePair& s, const Coefficients (&u)[2], const CellTable& lambda, int degree, Gaps gaps, const core::Comm& comm) {
  FeasiblePair::Parts parts;
  s.evaluate(u, lambda, degree, parts, 0, gaps);
  return {sum_of(comm, parts.whole, 2), 2 * sum_of(comm, parts.contact)};
}

/// Quadratic functions that are `height` at the vertices inside of the square and 0 at all other nodes.
Coefficients at_vertices(const PolynomialSpace& V, double height) {
  const Coefficients u = interpolated(V, scene::constant(0));
  const auto& entries = V.coefficients().element_entries;
  for (std::size_t k = 0; k < V.cells().extent(0); ++k)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex e = entries(k, V.basis().interior() + i);
      const auto& x = V.coefficients().entries.point[e];
      if (x[0] > 1e-9 && x[0] < 1 - 1e-9 && x[1] > 1e-9 && x[1] < 1 - 1e-9) u(e) = height;
    }
  return u;
}

class Pressed : public ::testing::TestWithParam<MethodName> {
 protected:
  mesh::Hierarchy levels = square(1);
  const mesh::Mesh& mesh = levels.finest();
  std::unique_ptr<PolynomialSpace> V = make_space(mesh, {GetParam(), 2});
  const FieldPtr zero = scene::constant(0);
  const FeasiblePair s{*V, two_membranes(mesh, zero, zero, scene::constant(1), scene::constant(3))};
  Coefficients lower = interpolated(*V, zero);
};

}  // namespace

TEST_P(Pressed, gaps_at_vertices_are_closed_where_the_multiplier_can_close_them) {
  const double height = 1e-3;
  const Coefficients u[2] = {at_vertices(*V, height), lower};
  const auto lambda = density_of(mesh, scene::constant(50), 0);
  const Price kept = price(s, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(s, u, lambda, 0, Gaps::pressed, mesh.comm);
  // mu_1 mu_2/(mu_1 + mu_2) |grad (u_1 - u_2)|²
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

TEST_P(Pressed, gaps_of_the_data_stay_as_they_are) {
  const auto above = scene::constant(0.1);
  const FeasiblePair apart(*V, two_membranes(mesh, above, zero, scene::constant(1), scene::constant(3)));
  const Coefficients u[2] = {interpolated(*V, above), lower};
  const auto lambda = density_of(mesh, scene::constant(1e6), 0);
  // vertices on the boundary keep 0.1 however large lambda is: the gap of the quadratic function that is 0.1 there stays
  const Price pressed = price(apart, u, lambda, 0, Gaps::pressed, mesh.comm);
  EXPECT_GT(pressed.contact, 1e6 * 0.01);
}

TEST_P(Pressed, gaps_of_membranes_that_come_apart_are_kept) {
  const auto bump = scene::formula([](double x, double y) { return 1e-4 * x * (1 - x) * y * (1 - y); });
  const Coefficients u[2] = {interpolated(*V, bump, zero), lower};
  const auto lambda = density_of(mesh, scene::constant(50), 0);
  const Price kept = price(s, u, lambda, 0, Gaps::kept, mesh.comm), pressed = price(s, u, lambda, 0, Gaps::pressed, mesh.comm);
  EXPECT_EQ(pressed.energy, kept.energy);
  EXPECT_EQ(pressed.contact, kept.contact);
}

INSTANTIATE_TEST_SUITE_P(Methods, Pressed, ::testing::Values(MethodName::fem, MethodName::dg, MethodName::hho));

namespace {

double height(double x, double y) { return 0.3 * std::sin(x + 2 * y) + 0.2 * x * x * x * x * x; }

/// |||psi - psi_I|||², psi_I the interpolant.
double energy_of_interpolation(const PolynomialSpace& V, const Coefficients& psi) {
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
  for (const MethodName name : {MethodName::fem, MethodName::hho})
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

/// Data above the obstacle that are no polynomials hold s where they are: there psi is not followed.
TEST(PressedObstacle, data_above_it_are_kept_on_the_held_boundary) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto psi = scene::formula(height);
  const auto V = make_space(mesh, {MethodName::fem, 3});
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
    const auto V = make_space(mesh, {MethodName::fem, p});
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

TEST(ObstacleThatJumps, the_majorant_is_nowhere_below_it_and_contact_points_stay_in_its_range) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto psi = scene::formula(step);
  for (const Nodes family : {Nodes::gauss_lobatto, Nodes::bernstein})
    for (int p = 2; p <= 4; ++p) {
      const auto V = make_space(mesh, {MethodName::dg, p, family});
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

}  // namespace thixis::equilibration
