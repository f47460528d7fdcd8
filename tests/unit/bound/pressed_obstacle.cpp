/// The feasible function that follows an obstacle which is more than its interpolant.
#include "pressed_setting.hpp"

namespace thixis::bound {
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
    std::vector<double> gain(mesh.global_vertices, 0), cost = gain;  // by global id
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

}  // namespace thixis::bound
