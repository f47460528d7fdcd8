#include "deck/cases.hpp"
#include "thixis/core/error.hpp"

namespace thixis::membranes {
namespace {

using scene::constant;
using scene::Degree;

/// What the cases share whose solution is known: it gives the Dirichlet data on the whole boundary, and its contact ends at a circle of
/// radius R.
CatalogueEntry solved(const std::string& name, const std::vector<double>& centre, double R, const ExactMembranes& exact) {
  CatalogueEntry c = entry(name, centre);
  c.constants = {{"R", R}};
  c.scene.exact = exact;
  c.scene.interface_level_set = radial(centre, [R](double r) { return r - R; });
  for (int alpha = 0; alpha < c.scene.count; ++alpha) c.scene.default_boundary.value[alpha] = exact.u[alpha];
  return c;
}

/// u_1 = -u_2 = (r^2 - R^2)^N outside of the circle, lambda = 1000 r^3 (R^2 - r^2)^3 inside; N = 6.
CatalogueEntry smooth_contact() {
  const std::vector<double> centre = {0.5, 0.5};
  const double R = 1.0 / 3, R2 = R * R;
  const auto u1 = [R, R2](double r) { return r < R ? 0.0 : std::pow(r * r - R2, 6); };
  const auto slope = [R, R2](double r) { return r < R ? 0.0 : 12 * std::pow(r * r - R2, 5); };
  const auto lambda = [R, R2](double r) { return r < R ? 1000 * std::pow(r, 3) * std::pow(R2 - r * r, 3) : 0.0; };
  const auto f1 = [R, R2, lambda](double r) { return r < R ? -lambda(r) : -24 * std::pow(r * r - R2, 4) * (6 * r * r - R2); };

  ExactMembranes exact;
  exact.u[0] = radial(centre, u1);
  exact.u[1] = radial(centre, [u1](double r) { return -u1(r); });
  exact.gradient[0] = radial_gradient(centre, slope);
  exact.gradient[1] = radial_gradient(centre, [slope](double r) { return -slope(r); });
  exact.multiplier = radial(centre, lambda);
  CatalogueEntry c = solved("smooth contact", centre, R, exact);
  c.scene.force[0] = radial(centre, f1);
  c.scene.force[1] = radial(centre, [f1](double r) { return -f1(r); });
  return c;
}

/// u_1 = (r^2 - R^2)^2 outside of the circle, u_2 = 0, lambda = 8 R^2 inside.
CatalogueEntry discontinuous_multiplier() {
  const std::vector<double> centre = {0.5, 0.5};
  const double R = 1.0 / 3, R2 = R * R;
  ExactMembranes exact;
  exact.u[0] = radial(centre, [R, R2](double r) { return r < R ? 0.0 : std::pow(r * r - R2, 2); });
  exact.u[1] = constant(0);
  exact.gradient[0] = radial_gradient(centre, [R, R2](double r) { return r < R ? 0.0 : 4 * (r * r - R2); });
  exact.gradient[1] = {constant(0), constant(0)};
  exact.multiplier = radial(centre, [R, R2](double r) { return r < R ? 8 * R2 : 0.0; });
  CatalogueEntry c = solved("discontinuous multiplier", centre, R, exact);
  c.scene.force[0] = radial(centre, [R, R2](double r) { return r < R ? -8 * R2 : 8 * R2 - 16 * r * r; });
  c.scene.force[1] = exact.multiplier;
  return c;
}

/// Common to both disks: u_1 = g (2 r^2 - 1), lambda = 2 g inside of r = 1/sqrt 2. `u2`, `slope2` (u_2'(r)/r) and `f2` hold outside of
/// it; inside u_2 = u_1.
template <class U, class S, class F>
CatalogueEntry on_the_disk(const std::string& name, double g, U u2, S slope2, F f2) {
  const std::vector<double> centre = {0, 0};
  const double R = std::sqrt(0.5);
  const auto u1 = [g](double r) { return g * (2 * r * r - 1); };
  ExactMembranes exact;
  exact.u[0] = radial(centre, u1, Degree{2});
  exact.u[1] = radial(centre, [=](double r) { return r < R ? u1(r) : u2(r); });
  exact.gradient[0] = radial_gradient(centre, [g](double) { return 4 * g; });
  exact.gradient[1] = radial_gradient(centre, [=](double r) { return r < R ? 4 * g : slope2(r); });
  exact.multiplier = radial(centre, [=](double r) { return r < R ? 2 * g : 0.0; });
  CatalogueEntry c = solved(name, centre, R, exact);
  c.scene.force[0] = radial(centre, [=](double r) { return r < R ? -10 * g : -8 * g; });
  c.scene.force[1] = radial(centre, [=](double r) { return r < R ? -6 * g : f2(r); });
  c.scene.initial[0] = constant(g);
  c.scene.initial[1] = c.scene.initial[2] = constant(0);
  return c;
}

/// u_2 = c (1-r)(2 r^2 - 1) outside, c = g sqrt 2/(sqrt 2 - 1).
CatalogueEntry disk() {
  const double g = 0.05, c = g * std::sqrt(2.0) / (std::sqrt(2.0) - 1);
  return on_the_disk(
      "disk", g, [c](double r) { return c * (1 - r) * (2 * r * r - 1); }, [c](double r) { return c * (4 - 6 * r + 1 / r); },
      [c](double r) { return -c * (1 + 8 * r - 18 * r * r) / r; });
}

/// u_2 = A (1-r)(sqrt 2 r - 1) outside, A = 2 sqrt 2 g/(sqrt 2 - 1).
CatalogueEntry disk_b() {
  const double g = 0.05, s = std::sqrt(2.0), A = 2 * s * g / (s - 1);
  return on_the_disk(
      "disk b", g, [=](double r) { return A * (1 - r) * (s * r - 1); }, [=](double r) { return A * ((1 + s) / r - 2 * s); },
      [=](double r) { return A * (4 * s - (1 + s) / r); });
}

/// psi = 1/2 - r^2, f = 0: u = psi inside of the circle, where lambda = -Lap psi = 4; outside u = A + B ln r, with value and slope of psi
/// at r = R.
CatalogueEntry radial_obstacle() {
  const std::vector<double> centre = {0, 0};
  const double R = 0.6, B = -2 * R * R, A = 0.5 - R * R - B * std::log(R);
  const auto psi = [](double r) { return 0.5 - r * r; };
  ExactMembranes exact;
  exact.u[0] = radial(centre, [=](double r) { return r < R ? psi(r) : A + B * std::log(r); });
  exact.gradient[0] = radial_gradient(centre, [=](double r) { return r < R ? -2 : B / (r * r); });
  exact.multiplier = radial(centre, [R](double r) { return r < R ? 4.0 : 0.0; });
  CatalogueEntry c = solved("radial obstacle", centre, R, exact);
  c.scene.force[0] = constant(0);
  c.scene.obstacle = radial(centre, psi, Degree{2});
  return c;
}

/// f = -8, psi = -1/4, u = 0 on the boundary. Without the obstacle u would be at most f (R^2 - r^2)/4 in any disk of radius R in the
/// domain, so -1/2 in the middle of the unit square or lower: there is contact there, and in the unit disk.
CatalogueEntry torsion() {
  CatalogueEntry c = entry("torsion", {0, 0});
  c.scene.force[0] = constant(-8);
  c.scene.obstacle = constant(-0.25);
  c.scene.default_boundary.value[0] = constant(0);
  return c;
}

}  // namespace

CatalogueEntry case_at_rest(const std::string& name) {
  if (name == "smooth contact") return smooth_contact();
  if (name == "discontinuous multiplier") return discontinuous_multiplier();
  if (name == "disk") return disk();
  if (name == "disk b") return disk_b();
  if (name == "radial obstacle") return radial_obstacle();
  if (name == "torsion") return torsion();
  throw core::InputError("'" + name + "' is no catalogued case.");
}

}  // namespace thixis::membranes
