#include "verify/rock.hpp"

#include <algorithm>
#include <cmath>

namespace thixis::flow {
namespace {

using Real = long double;  // 1 - S_e is small where gas appears

constexpr int water = 0, hydrogen = 1;

}  // namespace

VerifiedRock::VerifiedRock(const TwoPhaseScene& scene, double P_ref) : rock_(scene.medium), P_ref_(P_ref) {
  H_ = rock_.henry * rock_.molar_mass_hydrogen;
  beta_l_ = rock_.density_water * rock_.molar_mass_hydrogen / rock_.molar_mass_water;
  beta_g_ = rock_.molar_mass_hydrogen / (8.314 * rock_.temperature);
  const double span = 1 - rock_.S_lr - rock_.S_gr;
  P_at_line_ = capillary(rock_.S_gr + rock_.regularization * span);
  S_e_line_ = 1 - rock_.regularization;
  if (scene.capillary_law != CapillaryLaw::quadratic) return;
  // value and slope of van Genuchten's law at s_g = 0.1
  const double s = 0.1, m = 1 - 1 / rock_.n, S_e = 1 - (s - rock_.S_gr) / span, P = capillary(s);
  const double slope = P / rock_.n / (std::pow(S_e, -1 / m) - 1) * std::pow(S_e, -1 / m - 1) / m / span;
  a_ = 2 * P / s - slope;
  b_ = (slope - P / s) / s;
  meets_at_ = s;
}

/// P_cp(s_g)                                                                                                            (2)
double VerifiedRock::capillary(double s_g) const {
  if (s_g < meets_at_) return s_g < 0 ? a_ * s_g : a_ * s_g + b_ * s_g * s_g;
  const Real span = Real(1) - rock_.S_lr - rock_.S_gr, gas = (Real(s_g) - rock_.S_gr) / span, m = 1 - Real(1) / rock_.n;
  if (1 - gas > S_e_line_) return static_cast<double>(P_at_line_ * s_g / (rock_.S_gr + rock_.regularization * span));
  return static_cast<double>(rock_.P_r * std::pow(std::pow(1 - std::min(gas, Real(0.99)), -1 / m) - 1, 1 / Real(rock_.n)));
}

VerifiedCell VerifiedRock::cell(const std::array<double, 3>& U) const {
  VerifiedCell of{U[0], U[1], U[2], U[1] + capillary(U[0]), 1, 0};
  const Real gas = (Real(U[0]) - rock_.S_gr) / (Real(1) - rock_.S_lr - rock_.S_gr);
  if (gas <= 0) return of;
  const Real m = 1 - Real(1) / rock_.n;
  const auto liquid = [&](Real S_e) { return std::sqrt(S_e) * std::pow(1 - std::pow(1 - std::pow(S_e, 1 / m), m), Real(2)); };
  const Real S_e = 1 - std::min(gas, Real(0.99)), line = 1 - Real(rock_.regularization);
  of.k_rl = static_cast<double>(S_e > line ? 1 - (1 - liquid(line)) * gas / rock_.regularization : liquid(S_e));
  of.k_rg = static_cast<double>(std::sqrt(1 - S_e) * std::pow(1 - std::pow(S_e, 1 / m), 2 * m));
  return of;
}

/// Upwind by the potentials                                                                                              (3)
Crossing VerifiedRock::crossing(const VerifiedCell& A, const VerifiedCell& B, double distance, double down) const {
  const double liquid_falls = A.P - B.P + rock_.density_water * down * distance;
  const double gas_falls = A.P_g - B.P_g + 0.5 * beta_g_ * (A.P_g + B.P_g) * down * distance;
  const VerifiedCell &liquid = liquid_falls >= 0 ? A : B, &gas = gas_falls >= 0 ? A : B;
  const double through_liquid = rock_.permeability * liquid.k_rl / rock_.viscosity_water / distance;
  const double through_gas = rock_.permeability * gas.k_rg / rock_.viscosity_hydrogen / distance * beta_g_ * gas.P_g;
  const double diffusing = rock_.porosity * beta_l_ * rock_.diffusion * (1 - A.s_g + 1 - B.s_g) / 2 / distance;
  const double J = diffusing * (A.chi - B.chi);
  Crossing of;
  of.mass[water] = rock_.density_water * through_liquid * liquid_falls - J;
  of.mass[hydrogen] = beta_l_ * liquid.chi * through_liquid * liquid_falls + through_gas * gas_falls + J;
  const double P = std::max(std::abs(A.P), std::abs(B.P)), P_g = std::max(std::abs(A.P_g), std::abs(B.P_g));
  const double diffuses = std::abs(diffusing) * std::max(std::abs(A.chi), std::abs(B.chi));
  of.terms[water] = rock_.density_water * through_liquid * P + diffuses;
  of.terms[hydrogen] = beta_l_ * std::abs(liquid.chi) * through_liquid * P + std::abs(through_gas) * P_g + diffuses;
  return of;
}

double VerifiedRock::mass(const VerifiedCell& U, int component) const {
  return rock_.porosity * (component == water ? -rock_.density_water * U.s_g : beta_l_ * U.chi * (1 - U.s_g) + beta_g_ * U.P_g * U.s_g);
}

double VerifiedRock::filled(int component) const { return rock_.porosity * (component == water ? rock_.density_water : H_ * P_ref_); }

double VerifiedRock::driest() const { return rock_.S_gr + 0.99 * (1 - rock_.S_lr - rock_.S_gr); }

}  // namespace thixis::flow
