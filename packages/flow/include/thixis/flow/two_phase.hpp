#pragma once
#include <memory>

#include "thixis/algebra/solver.hpp"
#include "thixis/complementarity/parameters.hpp"
#include "thixis/flow/scene.hpp"
#include "thixis/models/evolution.hpp"

namespace thixis::flow {

/// What the estimate of two-phase flow measures (docs/methods/two_phase_estimates.md).
struct TwoPhaseBoundParams {
  complementarity::Measure measure = complementarity::Measure::residual;
  double time_scale = 2500 * 31557600.;  ///< alpha [s]
  /// The rule of the solver leaves errors of linearization that count as small beside others: they are not owed to the next step.
  bool adaptive = false;
};

/// Two-phase flow of water and hydrogen by cell-centred finite volumes and backward Euler (docs/methods/two_phase.md).
///
/// `seconds_per_unit`: of the unit of time of the deck. Without probes series.csv shows the cell at the left end, the lowest one there.
std::unique_ptr<models::UnsteadyModel> two_phase(TwoPhaseScene scene, algebra::LinearParams linear, double seconds_per_unit,
                                                 const TwoPhaseBoundParams& bound = {});

}  // namespace thixis::flow
