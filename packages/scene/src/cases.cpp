#include "cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "thixis/core/error.hpp"

namespace thixis::scene {
namespace {

/// A function of the distance to a centre.
template <class F>
FieldPtr radial(const std::vector<double>& centre, F f, std::optional<Degree> degree = {}) {
  return formula([cx = centre[0], cy = centre[1], f](double x, double y) { return f(std::hypot(x - cx, y - cy)); },
                 "a function of the scene", degree);
}

/// Gradient of the radial function with f'(r) = r * slope(r): slope(r) (x - centre).
template <class F>
std::array<FieldPtr, 2> radial_gradient(const std::vector<double>& centre, F slope) {
  const double cx = centre[0], cy = centre[1];
  return {formula([=](double x, double y) { return slope(std::hypot(x - cx, y - cy)) * (x - cx); }),
          formula([=](double x, double y) { return slope(std::hypot(x - cx, y - cy)) * (y - cy); })};
}

/// What all cases share: unit tensions.
CatalogueEntry entry(const std::string& name, const std::vector<double>& centre) {
  CatalogueEntry c;
  c.centre = centre;
  c.scene.name = name;
  for (const Case& known : cases())
    if (known.name == name) {
      c.scene.sentence = known.sentence;
      c.scene.count = known.model == Model::obstacle ? 1 : 2;
    }
  for (int alpha = 0; alpha < c.scene.count; ++alpha) c.scene.tension[alpha] = constant(1);
  return c;
}

/// What the cases share whose solution is known: it gives the Dirichlet data on the whole boundary, and its contact ends at a circle of
/// radius R.
CatalogueEntry entry(const std::string& name, const std::vector<double>& centre, double R, const ExactMembranes& exact) {
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
  CatalogueEntry c = entry("smooth contact", centre, R, exact);
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
  CatalogueEntry c = entry("discontinuous multiplier", centre, R, exact);
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
  CatalogueEntry c = entry(name, centre, R, exact);
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
  CatalogueEntry c = entry("radial obstacle", centre, R, exact);
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

// -- in time --------------------------------------------------------------------------------------------------------------------------

/// Forces that change their sign from ring to ring press the membranes together at several places.
CatalogueEntry rings() {
  constexpr double g = 0.05;
  const std::vector<double> centre = {0, 0};
  const auto by_ring = [&](const std::array<double, 5>& force) {
    return radial(centre, [force](double r) { return g * force[std::min(4, static_cast<int>(5 * r))]; });
  };
  CatalogueEntry c = entry("rings", centre);
  c.scene.force[0] = by_ring({-20, -50, 50, -50, 50});
  c.scene.force[1] = by_ring({90, -40, 70, -30, 40});
  c.scene.interface_level_set = radial(centre, [](double r) { return (r - 0.2) * (r - 0.4) * (r - 0.6) * (r - 0.8); });
  c.scene.default_boundary.value[0] = c.scene.initial[0] = constant(g);
  c.scene.default_boundary.value[1] = c.scene.initial[1] = constant(0);
  return c;
}

/// Flat at first, pressed together by constant forces, at rest in contact at last.
CatalogueEntry relaxation() {
  CatalogueEntry c = entry("relaxation", {0, 0});
  c.scene.tension[1] = constant(0.5);
  c.scene.force[0] = constant(-4);
  c.scene.force[1] = constant(2);
  c.scene.default_boundary.value[0] = c.scene.initial[0] = constant(0.1);
  c.scene.default_boundary.value[1] = c.scene.initial[1] = constant(-0.1);
  return c;
}

/// z = |x - c|² - R(t)², c the middle of the unit square; contact in z <= 0. W(z), z > 0, with two derivatives makes the gap h(t) W, and
/// L(z, R²), z <= 0, the multiplier h(t) L.
struct Opening {
  std::function<double(double)> R, R_t, W, W_z, W_zz;
  std::function<double(double, double)> L;
};
/// v = v_0 s(t) sin(pi x) sin(pi y), which both membranes share.
struct Swing {
  std::function<double(double)> s, s_t;
};
/// h(t).
struct Growth {
  std::function<double(double)> h, h_t;
};

/// u_1 = v + a_1 w, u_2 = v - a_2 w with w = h W(z), a_1 = mu_2/(mu_1 + mu_2), a_2 = mu_1/(mu_1 + mu_2), so that with
/// kappa = mu_1 mu_2/(mu_1 + mu_2)
///
///     f_1 = v_t + a_1 w_t - mu_1 Lap v - kappa Lap w - lambda,     f_2 = v_t - a_2 w_t - mu_2 Lap v + kappa Lap w + lambda,
///     w_t = h_t W + h W' z_t,  z_t = -2 R R_t,  grad w = 2 h W' (x - c),  Lap w = h (4 (z + R²) W'' + 4 W').
CatalogueEntry opening(const std::string& name, const Opening& o, const Swing& swing, const Growth& growth) {
  constexpr double mu[2] = {1, 0.5}, v0 = 0.5, pi = 3.14159265358979323846;
  constexpr double kappa = mu[0] * mu[1] / (mu[0] + mu[1]);
  const auto shape = [](double x, double y) { return std::sin(pi * x) * std::sin(pi * y); };
  const auto z = [o](double x, double y, double t) { return (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) - o.R(t) * o.R(t); };
  const auto lambda = [=](double x, double y, double t) {
    const double at = z(x, y, t);
    return at > 0 ? 0 : growth.h(t) * o.L(at, o.R(t) * o.R(t));
  };
  CatalogueEntry c = entry(name, {0.5, 0.5});
  ExactMembranes exact;
  exact.multiplier = formula(lambda);
  for (int alpha = 0; alpha < 2; ++alpha) {
    const double share = (alpha == 0 ? 1 : -1) * mu[1 - alpha] / (mu[0] + mu[1]), tension = mu[alpha];
    const double push = alpha == 0 ? 1 : -1;
    c.scene.tension[alpha] = constant(tension);
    exact.u[alpha] = formula([=](double x, double y, double t) {
      const double at = z(x, y, t);
      return v0 * swing.s(t) * shape(x, y) + (at > 0 ? share * growth.h(t) * o.W(at) : 0);
    });
    exact.gradient[alpha] = {formula([=](double x, double y, double t) {
                               const double at = z(x, y, t), slope = at > 0 ? 2 * share * growth.h(t) * o.W_z(at) : 0;
                               return v0 * swing.s(t) * pi * std::cos(pi * x) * std::sin(pi * y) + slope * (x - 0.5);
                             }),
                             formula([=](double x, double y, double t) {
                               const double at = z(x, y, t), slope = at > 0 ? 2 * share * growth.h(t) * o.W_z(at) : 0;
                               return v0 * swing.s(t) * pi * std::sin(pi * x) * std::cos(pi * y) + slope * (y - 0.5);
                             })};
    c.scene.force[alpha] = formula([=](double x, double y, double t) {
      const double at = z(x, y, t), R = o.R(t), h = growth.h(t);
      double force = v0 * shape(x, y) * (swing.s_t(t) + tension * 2 * pi * pi * swing.s(t)) - push * lambda(x, y, t);
      if (at > 0) {
        const double rate = growth.h_t(t) * o.W(at) - 2 * h * R * o.R_t(t) * o.W_z(at);
        const double laplace = 4 * h * ((at + R * R) * o.W_zz(at) + o.W_z(at));
        force += share * rate - push * kappa * laplace;
      }
      return force;
    });
    c.scene.default_boundary.value[alpha] = exact.u[alpha];
  }
  c.scene.exact = exact;
  return c;
}

const Swing swinging = {[](double t) { return std::cos(2 * t); }, [](double t) { return -2 * std::sin(2 * t); }};
const Swing rising = {[](double t) { return 1 + t; }, [](double) { return 1.0; }};
const Growth none = {[](double) { return 1.0; }, [](double) { return 0.0; }};
const Growth linear = {rising.s, rising.s_t};

/// R = 1/4 + sin(2 pi t)/10.
Opening breathing() {
  constexpr double pi = 3.14159265358979323846;
  Opening o;
  o.R = [](double t) { return 0.25 + 0.1 * std::sin(2 * pi * t); };
  o.R_t = [](double t) { return 0.2 * pi * std::cos(2 * pi * t); };
  return o;
}

/// W = 10 z²; the multiplier jumps from 8 kappa 10 R² to 0 at the free boundary, where the forces are continuous.
CatalogueEntry moving_contact() {
  Opening o = breathing();
  o.W = [](double z) { return 10 * z * z; };
  o.W_z = [](double z) { return 20 * z; };
  o.W_zz = [](double) { return 20.0; };
  o.L = [](double z, double R2) { return 80.0 / 3 * R2 - 10 * z; };
  return opening("moving contact", o, swinging, none);
}

/// W = 100 z⁶, L = 1000 (-z)³.
void make_smooth(Opening& o) {
  o.W = [](double z) { return 100 * std::pow(z, 6); };
  o.W_z = [](double z) { return 600 * std::pow(z, 5); };
  o.W_zz = [](double z) { return 3000 * std::pow(z, 4); };
  o.L = [](double z, double) { return 1000 * std::pow(-z, 3); };
}

CatalogueEntry smooth_moving_contact() {
  Opening o = breathing();
  make_smooth(o);
  return opening("smooth moving contact", o, swinging, none);
}

/// R = 1/4, everything affine in time: backward Euler is exact.
CatalogueEntry resting_contact() {
  Opening o;
  o.R = [](double) { return 0.25; };
  o.R_t = [](double) { return 0.0; };
  make_smooth(o);
  return opening("resting contact", o, rising, linear);
}

}  // namespace

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"smooth contact", Model::membranes,
       "Unit square: the membranes touch in a circle of radius 1/3, gap and multiplier are smooth; exact solution known."},
      {"discontinuous multiplier", Model::membranes,
       "Unit square: the upper membrane is pressed on a flat lower one, the multiplier jumps at r = 1/3; exact solution known."},
      {"disk", Model::membranes,
       "Unit disk: contact for r < 1/sqrt 2, the lower membrane a cubic of r outside, the multiplier jumps; exact solution known."},
      {"disk b", Model::membranes,
       "Unit disk: as 'disk' with a lower membrane that is quadratic in r outside of the contact; exact solution known."},
      {"radial obstacle", Model::obstacle,
       "Unit disk: a membrane over a paraboloid that it leaves at r = 0.6, where the multiplier jumps; exact solution known."},
      {"torsion", Model::obstacle,
       "Any domain, e.g. the unit square: a membrane held at height 0 and pressed by a constant force on a flat obstacle below."},
      {"rings", Model::parabolic_membranes,
       "Unit disk, in time: forces that change sign from ring to ring press flat membranes together at several places."},
      {"moving contact", Model::parabolic_membranes,
       "Unit square, in time: the edge of a contact disk moves to and fro, the multiplier jumps there; exact solution known."},
      {"smooth moving contact", Model::parabolic_membranes,
       "Unit square, in time: as 'moving contact' with a gap and a multiplier that are smooth; exact solution known."},
      {"resting contact", Model::parabolic_membranes,
       "Unit square, in time: the contact disk rests, gap and multiplier are smooth and affine in time; exact solution known."},
      {"relaxation", Model::parabolic_membranes,
       "Any domain, e.g. the unit square, in time: flat membranes pressed together by constant forces come to rest in contact."},
      {"gas injection", Model::two_phase,
       "Interval of 200 m: hydrogen enters water in clay on the left for 5e5 years, a gas phase appears and is gone by 7e5 years (MoMaS)."},
      {"gas injection short", Model::two_phase,
       "Interval of 200 m: as 'gas injection' with a quadratic capillary law near S = 1; published Newton counts until 5e5 years."},
      {"gas injection 2d", Model::two_phase,
       "200 m x 20 m, with gravity: hydrogen enters through the lowest quarter of the left side for 5e5 years."},
      {"closed column", Model::two_phase,
       "Interval of 20 m, upright, closed: hydrogen made at the foot becomes gas there, which dissolves again and gathers at the top."},
  };
  return all;
}

CatalogueEntry catalogue(const std::string& name) {
  if (name == "smooth contact") return smooth_contact();
  if (name == "discontinuous multiplier") return discontinuous_multiplier();
  if (name == "disk") return disk();
  if (name == "disk b") return disk_b();
  if (name == "radial obstacle") return radial_obstacle();
  if (name == "torsion") return torsion();
  if (name == "rings") return rings();
  if (name == "moving contact") return moving_contact();
  if (name == "smooth moving contact") return smooth_moving_contact();
  if (name == "resting contact") return resting_contact();
  if (name == "relaxation") return relaxation();
  throw core::InputError("'" + name + "' is no catalogued case.");
}

}  // namespace thixis::scene
