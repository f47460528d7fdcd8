#pragma once
#include "step/operator.hpp"

namespace thixis::flow {

/// Where Newton's method begins a step: X + ratio (X - X_before), ratio = length of the step over that of the step before, brought back to
/// the states that obey s_g >= 0, G >= 0, s_g G = 0 with the same pressures of the liquid and masses of hydrogen
/// (docs/methods/two_phase_estimates.md, 7). Collective.
Teuchos::RCP<algebra::Vector> predicted(const TwoPhaseOperator& flow, const algebra::Vector& X, const algebra::Vector& X_before,
                                        double ratio);

/// Where Newton's method begins the first step in a closed domain: X with the gas and the liquid of each cell in equilibrium, with the
/// masses of X. Water is not compressed, so that the saturations stay,
///
///     P_g = (beta_l chi (1 - s_g) + beta_g P_g s_g) / (H (1 - s_g) + beta_g s_g),   P = P_g - P_cp(s_g),   chi = H P_g/beta_l.
Teuchos::RCP<algebra::Vector> in_equilibrium(const TwoPhaseOperator& flow, const algebra::Vector& X);

}  // namespace thixis::flow
