#pragma once
#include <array>

#include "thixis/flow/scene.hpp"

namespace thixis::flow {

/// A state with its laws.
struct VerifiedCell {
  double s_g, P, chi, P_g, k_rl, k_rg;
};

/// Masses that cross a face [kg/(m^2 s)], and the terms whose differences they are. [0]: water, [1]: hydrogen.
struct Crossing {
  double mass[2] = {0, 0}, terms[2] = {0, 0};
  bool given = false;  ///< by the deck, whatever the state
};

/// The laws of docs/methods/two_phase.md as the verifier reads them there: no line is shared with those of the solver, so that a mistake
/// there shows.
class VerifiedRock {
 public:
  /// `P_ref`: size of the pressures [Pa].
  VerifiedRock(const TwoPhaseScene& scene, double P_ref);

  VerifiedCell cell(const std::array<double, 3>& s_g_P_chi) const;
  /// From A to B; `down`: gravity in that direction.
  Crossing crossing(const VerifiedCell& A, const VerifiedCell& B, double distance, double down) const;
  /// Per volume [kg/m^3]; that of water is counted from full pores, so that no digits are lost.
  double mass(const VerifiedCell& U, int component) const;
  /// In full pores of water, and in those of water that holds as much hydrogen as it can at P_ref.
  double filled(int component) const;
  /// G/(H P_ref)
  double undersaturation(const VerifiedCell& U) const { return (H_ * U.P_g - beta_l_ * U.chi) / (H_ * P_ref_); }
  /// chi beta_l/(H P_ref)
  double dissolved(const VerifiedCell& U) const { return U.chi * beta_l_ / (H_ * P_ref_); }
  /// The largest saturation of the gas that leaves liquid which flows.
  double driest() const;
  double P_ref() const { return P_ref_; }

 private:
  double capillary(double s_g) const;

  RockAndFluids rock_;
  double P_ref_;
  double H_, beta_l_, beta_g_;           ///< of the document
  double S_e_line_ = 1, P_at_line_ = 0;  ///< P_cp is a line from there to s_g = 0
  double a_ = 0, b_ = 0, meets_at_ = 0;  ///< of the quadratic law, up to this s_g
};

}  // namespace thixis::flow
