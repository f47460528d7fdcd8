#include <algorithm>
#include <functional>

#include "deck/cases.hpp"
#include "thixis/core/error.hpp"

namespace thixis::membranes {
namespace {

using scene::constant;
using scene::formula;

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

CatalogueEntry case_in_time(const std::string& name) {
  if (name == "rings") return rings();
  if (name == "moving contact") return moving_contact();
  if (name == "smooth moving contact") return smooth_moving_contact();
  if (name == "resting contact") return resting_contact();
  if (name == "relaxation") return relaxation();
  throw core::InputError("'" + name + "' is no catalogued case.");
}

}  // namespace thixis::membranes
