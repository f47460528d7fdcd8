#pragma once
#include <Kokkos_Core.hpp>

#include "thixis/flow/scene.hpp"

/// Constitutive laws and face fluxes of two-phase flow with their derivatives (docs/methods/two_phase.md, 2 and 3). SI units.
namespace thixis::flow {

/// A function of the gas saturation s_g at one place, and its derivative by s_g.
struct Law {
  double value = 0, slope = 0;
};

/// Components, and the unknowns (s_g, P, chi) of a cell in this order.
enum Component { water = 0, hydrogen = 1 };
enum Unknown { gas_saturation = 0, pressure = 1, dissolved = 2 };
constexpr int components = 2, unknowns_per_cell = 3;

/// The unknowns of a cell, or of a face of the boundary, with the laws there.
struct PhaseState {
  double s_g = 0, P = 0, chi = 0;
  Law P_g;         ///< pressure of the gas P + P_cp(s_g), also where there is no gas; its derivative by P is 1
  Law k_rl, k_rg;  ///< relative permeabilities
};

/// Masses per volume [kg/m^3] with their derivatives: d[component][unknown]. That of water is counted from phi rho_w, that of the rock
/// filled with it: the difference of two saturations near 1 would lose digits.
struct Masses {
  double value[components];
  double d[components][unknowns_per_cell];
};

/// Masses that cross a face from its first to its second side [kg/(m^2 s)], with their derivatives by the unknowns on both sides.
struct FaceFlux {
  double value[components];
  double by_first[components][unknowns_per_cell];
  double by_second[components][unknowns_per_cell];
};

/// With e = 1 - S_e = (s_g - S_gr)/(1 - S_lr - S_gr) and functions of e that cancel nothing for small e:
///
///     P_cp = P_r (S_e^{-1/m} - 1)^{1/n},   k_rl = √S_e (1 - (1 - S_e^{1/m})^m)²,   k_rg = √(1-S_e) (1 - S_e^{1/m})^{2m},   m = 1 - 1/n.
///
/// P_cp and k_rl have infinite slopes at e = 0: for e < eps they are straight lines, P_cp to 0 at s_g = 0 and on below, k_rl to 1 at e = 0.
/// Gas below S_gr does not move: k_rg = 0, k_rl = 1 for e < 0. For e > dry, far from all states of interest, P_cp and k_rg go on along
/// their tangents, and k_rl = 0 for e >= 1, so that all laws are finite for every finite s_g.
struct TwoPhaseLaws {
  double porosity, permeability, viscosity_l, viscosity_g;
  double rho_w;              ///< density of water, and of the liquid in its weight
  double diffusion;          ///< D
  double H, beta_l, beta_g;  ///< H~ M_h, rho_w M_h/M_w, M_h/(R T) [kg/(Pa m^3), kg/m^3, kg/(Pa m^3)]
  double gravity[2];

  double n, m, P_r, S_gr, width;  ///< width = 1 - S_lr - S_gr
  double eps;
  double slope_wet_c, slope_wet_l;  ///< P_cp/e and (1 - k_rl)/e at e = eps
  Law dry_c, dry_g;                 ///< P_cp and k_rg at e = dry, slopes by e
  bool quadratic;
  double a, b;  ///< of the quadratic law a s_g + b s_g²

  static constexpr double dry = 0.99;              ///< e beyond which the laws are tangents
  static constexpr double end_of_quadratic = 0.1;  ///< s_g

  /// 1 - S_e^{1/m}
  KOKKOS_INLINE_FUNCTION double complement(double e) const { return -std::expm1(std::log1p(-e) / m); }

  // van Genuchten–Mualem, functions of e for eps <= e <= dry; slopes by e
  KOKKOS_INLINE_FUNCTION Law true_capillary(double e) const {
    const double X = std::expm1(-std::log1p(-e) / m), P = P_r * std::pow(X, 1 / n);
    return {P, P / (n * X) * (X + 1) / (m * (1 - e))};
  }
  KOKKOS_INLINE_FUNCTION Law true_k_rl(double e) const {
    const double c = complement(e), power = std::pow(c, m), q = 1 - power, root = std::sqrt(1 - e);
    const double dc = (1 - c) / (m * (1 - e));
    return {root * q * q, -0.5 / root * q * q - 2 * root * q * m * power / c * dc};
  }
  KOKKOS_INLINE_FUNCTION Law true_k_rg(double e) const {
    const double c = complement(e), power = std::pow(c, 2 * m), root = std::sqrt(e);
    const double dc = (1 - c) / (m * (1 - e));
    return {root * power, 0.5 / root * power + root * 2 * m * power / c * dc};
  }

  KOKKOS_INLINE_FUNCTION double e_of(double s_g) const { return (s_g - S_gr) / width; }
  KOKKOS_INLINE_FUNCTION Law by_s_g(const Law& by_e) const { return {by_e.value, by_e.slope / width}; }

  KOKKOS_INLINE_FUNCTION Law capillary(double s_g) const {
    if (quadratic && s_g < end_of_quadratic) return s_g < 0 ? Law{a * s_g, a} : Law{(a + b * s_g) * s_g, a + 2 * b * s_g};
    const double e = e_of(s_g);
    if (e < eps) {
      const double wet = width + S_gr / eps;  // the line ends at s_g = eps wet
      return {slope_wet_c * (s_g / wet), slope_wet_c / wet};
    }
    if (e > dry) return by_s_g({dry_c.value + dry_c.slope * (e - dry), dry_c.slope});
    return by_s_g(true_capillary(e));
  }
  KOKKOS_INLINE_FUNCTION Law k_rl(double s_g) const {
    const double e = e_of(s_g);
    if (e <= 0) return {1, 0};
    if (e < eps) return by_s_g({1 - slope_wet_l * e, -slope_wet_l});
    if (e >= 1) return {0, 0};
    return by_s_g(true_k_rl(e));
  }
  KOKKOS_INLINE_FUNCTION Law k_rg(double s_g) const {
    const double e = e_of(s_g);
    if (e <= 0) return {0, 0};
    if (e > dry) return by_s_g({dry_g.value + dry_g.slope * (e - dry), dry_g.slope});
    return by_s_g(true_k_rg(e));
  }

  KOKKOS_INLINE_FUNCTION PhaseState state(double s_g, double P, double chi) const {
    const Law P_c = capillary(s_g);
    return {s_g, P, chi, {P + P_c.value, P_c.slope}, k_rl(s_g), k_rg(s_g)};
  }

  /// l_w - phi rho_w = -phi rho_w s_g,   l_h = phi (beta_l chi (1 - s_g) + beta_g P_g s_g)
  KOKKOS_INLINE_FUNCTION Masses masses(const PhaseState& U) const {
    const double s = U.s_g;
    return {{-porosity * rho_w * s, porosity * (beta_l * U.chi * (1 - s) + beta_g * U.P_g.value * s)},
            {{-porosity * rho_w, 0, 0},
             {porosity * (beta_g * (U.P_g.value + U.P_g.slope * s) - beta_l * U.chi), porosity * beta_g * s, porosity * beta_l * (1 - s)}}};
  }

  /// G = H P_g - beta_l chi [kg/m^3] and its derivatives.
  KOKKOS_INLINE_FUNCTION double undersaturation(const PhaseState& U) const { return H * U.P_g.value - beta_l * U.chi; }
  KOKKOS_INLINE_FUNCTION void undersaturation_slopes(const PhaseState& U, double d[unknowns_per_cell]) const {
    d[gas_saturation] = H * U.P_g.slope;
    d[pressure] = H;
    d[dissolved] = -beta_l;
  }

  /// Between A and B at distance d; g_n = g·n with the normal from A to B. Upwind by the potentials,
  ///
  ///     q_l = K k_rl(S_up)/mu_l (P_A - P_B + rho_w g_n d)/d,      q_g = K k_rg(S_up)/mu_g (P^g_A - P^g_B + beta_g (P^g_A + P^g_B)/2 g_n
  ///     d)/d, J = phi beta_l D (S_A + S_B)/2 (chi_A - chi_B)/d,   Phi_w = rho_w q_l - J,   Phi_h = beta_l chi_up q_l + beta_g P^g_up q_g +
  ///     J.
  KOKKOS_INLINE_FUNCTION FaceFlux flux(const PhaseState& A, const PhaseState& B, double d, double g_n) const {
    FaceFlux F{};
    add_liquid(A, B, d, g_n, F);
    add_gas(A, B, d, g_n, F);
    add_diffusion(A, B, d, F);
    return F;
  }

 private:
  KOKKOS_INLINE_FUNCTION void add_liquid(const PhaseState& A, const PhaseState& B, double d, double g_n, FaceFlux& F) const {
    const double fall = A.P - B.P + rho_w * g_n * d, conductance = permeability / (viscosity_l * d);
    const bool first = fall >= 0;
    const PhaseState& up = first ? A : B;
    const double mobility = conductance * up.k_rl.value, q = mobility * fall;
    double(&by_up)[components][unknowns_per_cell] = first ? F.by_first : F.by_second;
    for (int c = 0; c < components; ++c) {
      const double density = c == water ? rho_w : beta_l * up.chi;
      F.value[c] += density * q;
      F.by_first[c][pressure] += density * mobility;
      F.by_second[c][pressure] -= density * mobility;
      by_up[c][gas_saturation] += density * conductance * up.k_rl.slope * fall;
    }
    by_up[hydrogen][dissolved] += beta_l * q;
  }

  KOKKOS_INLINE_FUNCTION void add_gas(const PhaseState& A, const PhaseState& B, double d, double g_n, FaceFlux& F) const {
    const double weight = 0.5 * beta_g * g_n * d;
    const double fall = A.P_g.value - B.P_g.value + weight * (A.P_g.value + B.P_g.value);
    const double conductance = beta_g * permeability / (viscosity_g * d);
    const bool first = fall >= 0;
    const PhaseState& up = first ? A : B;
    const double mobility = conductance * up.P_g.value * up.k_rg.value;
    F.value[hydrogen] += mobility * fall;
    F.by_first[hydrogen][gas_saturation] += mobility * (1 + weight) * A.P_g.slope;
    F.by_first[hydrogen][pressure] += mobility * (1 + weight);
    F.by_second[hydrogen][gas_saturation] -= mobility * (1 - weight) * B.P_g.slope;
    F.by_second[hydrogen][pressure] -= mobility * (1 - weight);
    double(&by_up)[components][unknowns_per_cell] = first ? F.by_first : F.by_second;
    by_up[hydrogen][gas_saturation] += conductance * fall * (up.P_g.slope * up.k_rg.value + up.P_g.value * up.k_rg.slope);
    by_up[hydrogen][pressure] += conductance * fall * up.k_rg.value;
  }

  KOKKOS_INLINE_FUNCTION void add_diffusion(const PhaseState& A, const PhaseState& B, double d, FaceFlux& F) const {
    const double conductance = porosity * beta_l * diffusion / d, S = 1 - 0.5 * (A.s_g + B.s_g), fall = A.chi - B.chi;
    for (int c = 0; c < components; ++c) {
      const double sign = c == water ? -conductance : conductance;
      F.value[c] += sign * S * fall;
      F.by_first[c][gas_saturation] -= sign * 0.5 * fall;
      F.by_second[c][gas_saturation] -= sign * 0.5 * fall;
      F.by_first[c][dissolved] += sign * S;
      F.by_second[c][dissolved] -= sign * S;
    }
  }
};

TwoPhaseLaws two_phase_laws(const TwoPhaseScene& scene);

}  // namespace thixis::flow
