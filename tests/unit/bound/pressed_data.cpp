/// The feasible pair where boundary data are more than their interpolant.
#include "pressed_setting.hpp"

namespace thixis::bound {
namespace {

/// Zero at vertices of the square(1), and half the way between them.
double between_nodes(double x) {
  const double t = 8 * x - std::floor(8 * x);
  return t * (1 - t) * std::pow(1 - 2 * t, 2);
}

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

}  // namespace thixis::bound
