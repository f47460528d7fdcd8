#include "step/step_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "estimate/square.hpp"

namespace thixis::bound {
namespace {

/// What no flux balances: rho_alpha, the rate of change of the data and of the pair. It enters by Friedrichs' inequality where there is
/// one, else by its norm in L1(L2), as means do that no flux takes away.
struct Unbalanced {
  double balanced = 0;         ///< N = (sum_alpha C²/mu_alpha rho_alpha²)^{1/2}
  double force = 0;            ///< what the change of the forces is of it
  double whole = 0, disc = 0;  ///< R, and its part in the discretization
  double lin = 0, alg = 0;
};

Unbalanced unbalanced(const StepFigures& of) {
  Unbalanced sum;
  const double root_tau = std::sqrt(of.tau);
  double balanced2 = 0, force2 = 0, whole2 = 0, disc2 = 0;
  for (int alpha = 0; alpha < of.count; ++alpha) {
    const double of_force = std::sqrt(of.force[alpha]);
    const double of_pair = std::sqrt(of.sum[OfStep::lift_1 + alpha]) + of.apart[alpha] * std::sqrt(of.sum[OfStep::moved]) +
                           std::sqrt(bulge_rate * of.sum[OfStep::bulge_1 + alpha]);
    const double rho = of_force + of_pair / root_tau, factor = squared(of.friedrichs) / of.least[alpha];
    balanced2 += factor * squared(rho);
    force2 += (of.friedrichs > 0 ? factor : 4 * of.tau) * squared(of_force);
    const double in_disc = (of.friedrichs > 0 ? 0 : root_tau * rho) + of.tau * of.left_disc[alpha];
    whole2 += squared(in_disc + of.tau * (of.left_lin[alpha] + of.left_alg[alpha]));
    disc2 += squared(in_disc);
  }
  sum.balanced = std::sqrt(balanced2);
  sum.force = std::sqrt(force2);
  sum.whole = std::sqrt(whole2);
  sum.disc = std::sqrt(disc2);
  sum.lin = of.tau * std::hypot(of.left_lin[0], of.left_lin[1]);
  sum.alg = of.tau * std::hypot(of.left_alg[0], of.left_alg[1]);
  return sum;
}

}  // namespace

StepEstimate estimate(const StepFigures& of) {
  const Unbalanced rest = unbalanced(of);
  const auto over_step = [&](double per_time) { return std::sqrt(of.tau * per_time); };
  const double contact = of.sum[OfStep::contact], then = of.sum[OfStep::contact_then], at_points = of.sum[OfStep::contact_at_points];
  const double together = std::max(0.0, contact + then + 2 * bulge_mean * of.sum[OfStep::contact_of_bulge]);
  StepEstimate step;
  step.square.energy = squared(over_step(of.flux[OfFlux::whole]) + rest.balanced) + of.tau * (of.sum[OfStep::pair] + together);
  step.square.remainder = rest.whole;
  step.parts = {
      over_step(of.flux[OfFlux::disc]) + rest.balanced + over_step(of.sum[OfStep::rest]) + over_step(std::abs(together - at_points)),
      over_step(of.flux[OfFlux::lin]) + over_step(of.sum[OfStep::at_nodes]) + over_step(at_points), over_step(of.flux[OfFlux::alg])};
  step.errors.time = over_step(of.flux[OfFlux::change]) + rest.force + over_step(std::max(0.0, then));
  step.errors.space = std::max(0.0, rest.balanced + 2 * rest.disc - rest.force) + over_step(of.sum[OfStep::rest_at_end]) +
                      over_step(std::abs(contact - at_points));
  step.eta.total = step.square.bound();
  step.eta.discretization = step.parts[0] + 2 * rest.disc;
  step.eta.linearization = step.parts[1] + 2 * rest.lin;
  step.eta.algebraic = step.parts[2] + 2 * rest.alg;
  step.eta.time = step.errors.time;
  return step;
}

}  // namespace thixis::bound
