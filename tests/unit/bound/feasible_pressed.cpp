/// The feasible pair where the multiplier presses on gaps that contact leaves open at vertices.
#include "pressed_setting.hpp"

namespace thixis::bound {
namespace {

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

}  // namespace thixis::bound
