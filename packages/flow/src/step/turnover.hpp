#pragma once
#include "step/operator.hpp"

namespace thixis::flow {

/// What a step of flow is about, from the state before it: Euclidean norms over all cells, masses per volume [kg/m^3].
struct Turnover {
  /// tau (|Q_c| + sum_F |F| |Phi_c|/|K|): what sources, boundary and fluxes move, without the cancellation between in and out
  double moved[components] = {0, 0};
  /// A unit in the last place of the pressures, molar fractions and masses, in the balance of a cell.
  double rounding[components] = {0, 0};
};

/// Collective.
Turnover turnover(const TwoPhaseOperator& flow, const FlowStep& step);

}  // namespace thixis::flow
