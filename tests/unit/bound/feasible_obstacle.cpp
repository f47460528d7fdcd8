/// One membrane over an obstacle that is no polynomial: s >= psi with psi itself.
#include "feasible_setting.hpp"

namespace thixis::bound {
namespace {

/// max(0, 1/4 - distance from the centre in the maximum norm), and the curve along which it has its kinks.
double pyramid(double x, double y) { return std::max(0.0, 0.25 - std::max(std::abs(x - 0.52), std::abs(y - 0.47))); }
double kinks(double x, double y) {
  const double a = std::abs(x - 0.52), b = std::abs(y - 0.47);
  return (0.25 - std::max(a, b)) * (a - b);
}
void slope_of_pyramid(double x, double y, double (&g)[2]) {
  const double a = x - 0.52, b = y - 0.47;
  g[0] = g[1] = 0;
  if (std::max(std::abs(a), std::abs(b)) >= 0.25) return;
  if (std::abs(a) > std::abs(b)) g[0] = a > 0 ? -1 : 1;
  else g[1] = b > 0 ? -1 : 1;
}

}  // namespace

TEST(FeasibleObstacle, a_membrane_through_a_pyramid_is_lifted_on_it) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  for (int p = 1; p <= 3; ++p) {
    const auto V = make_space(mesh, {"fem", p}, scene::formula([](double x, double y) { return kinks(x, y); }));
    const auto u1 = scene::formula([](double x, double y) { return 2.2 * x * (1 - x) * y * (1 - y); });
    const FeasiblePair s(
        *V, {1, {scene::constant(2), nullptr}, {everywhere(mesh, scene::constant(0)), {}}, scene::formula([](double x, double y) {
               return pyramid(x, y);
             })});
    EXPECT_EQ(s.boundary_energy(), 0);
    const Coefficients u[2] = {interpolated(*V, u1, scene::constant(0)), {}};
    FeasiblePair::Parts parts;
    s.evaluate(u, density_of(mesh, scene::constant(3), 0), 0, parts);
    // the least that a move up to psi can cost, and the contact term, both of s
    std::vector<double> psi_at(V->coefficients().entries.size());
    for (std::size_t e = 0; e < psi_at.size(); ++e)
      psi_at[e] = pyramid(V->coefficients().entries.point[e][0], V->coefficients().entries.point[e][1]);
    Sampler sample(*V);
    double whole2 = 0, contact = 0;
    densely(mesh, 24, [&](double weight, const PointOfCell& at) {
      auto c = sample.coefficients(u[0], at.cell), raised = c;
      for (std::size_t l = 0; l < c.size(); ++l) raised[l] = std::max(c[l], psi_at[V->coefficients().element_entries(at.cell, l)]);
      sample.at(at);
      double slope[2];
      slope_of_pyramid(at.x, at.y, slope);
      const Sample before = sample(c), after = sample(raised);
      const bool below = after.value < pyramid(at.x, at.y);
      for (int d = 0; d < 2; ++d) whole2 += weight * 2 * std::pow((below ? slope[d] : after.gradient[d]) - before.gradient[d], 2);
      contact += weight * 3 * std::max(after.value - pyramid(at.x, at.y), 0.0);
    });
    whole2 = mesh.comm.sum(whole2);
    const double bound2 = sum_of(mesh.comm, parts.whole, 2);
    EXPECT_GT(whole2, 1e-3);
    EXPECT_GT(bound2, 0.97 * whole2);
    EXPECT_LT(bound2, 2 * whole2);  // two pieces, by the triangle inequality
    EXPECT_NEAR(sum_of(mesh.comm, parts.contact), mesh.comm.sum(contact), 0.01 * mesh.comm.sum(contact));
  }
}

TEST(FeasibleObstacle, above_a_curved_one_nothing_is_done_and_the_contact_term_sees_it) {
  const auto levels = square(2);
  const auto& mesh = levels.finest();
  for (int p = 1; p <= 4; ++p) {
    const auto V = make_space(mesh, {"fem", p});
    const auto psi = scene::formula([](double x, double y) { return -1 + std::sin(3 * x) * std::sin(2 * y); });
    const FeasiblePair s(*V, {1, {scene::constant(1), nullptr}, {everywhere(mesh, scene::constant(1)), {}}, psi});
    FeasiblePair::Parts parts;
    s.evaluate({interpolated(*V, scene::constant(1)), {}}, density_of(mesh, scene::constant(1), 0), 0, parts);
    EXPECT_LT(sum_of(mesh.comm, parts.whole), 1e-12);
    const double integral = 2 - (1 - std::cos(3)) / 3 * (1 - std::cos(2)) / 2;
    EXPECT_NEAR(sum_of(mesh.comm, parts.contact), integral, 1e-7);
  }
}

TEST(FeasibleObstacle, a_flat_one_is_treated_like_a_membrane) {
  const auto levels = square(1);
  const auto& mesh = levels.finest();
  const auto V = make_space(mesh, {"fem", 3});
  const auto u1 = scene::formula([](double x, double y) { return 0.1 - std::sin(3 * x) * y * (1 - y); });
  const Coefficients u[2] = {interpolated(*V, u1, scene::constant(0.1)), interpolated(*V, scene::constant(0))};
  FeasiblePair::Parts over, held;
  const FeasiblePair obstacle(*V, {1, {scene::constant(1), nullptr}, {everywhere(mesh, scene::constant(0.1)), {}}, scene::constant(0)});
  const FeasiblePair stiff(*V, two_membranes(mesh, scene::constant(0.1), scene::constant(0), scene::constant(1), scene::constant(1e12)));
  const auto lambda = density_of(mesh, scene::constant(1), 1);
  obstacle.evaluate(u, lambda, 1, over);
  stiff.evaluate(u, lambda, 1, held);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    EXPECT_NEAR(over.whole(K), held.whole(K), 1e-5);
    EXPECT_NEAR(over.contact(K), held.contact(K), 1e-8);
  }
}

}  // namespace thixis::bound
