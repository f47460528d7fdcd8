#pragma once
#include "two_phase_operator.hpp"

namespace thixis::models {

/// Where Newton's method begins a step: X + ratio (X - X_before), ratio = length of the step over that of the step before, brought back to
/// the states that obey s_g >= 0, G >= 0, s_g G = 0 with the same pressures of the liquid and masses of hydrogen
/// (docs/methods/two_phase_estimates.md, 7). Collective.
Teuchos::RCP<algebra::Vector> predicted(const TwoPhaseOperator& flow, const algebra::Vector& X, const algebra::Vector& X_before,
                                        double ratio);

}  // namespace thixis::models
