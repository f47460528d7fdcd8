#include "steps/refined.hpp"

#include <cmath>

#include "refine/marking.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::drive {

bool refined(models::Evolution& evolution, const RunParams& params, const models::TimeStep& step, const complementarity::Estimate& eta,
             EvolutionOutcome& outcome, const EvolutionObserver& observer) {
  if (!params.stopping.target || !evolution.hierarchy()) return false;
  const double share = *params.stopping.target * std::sqrt(step.length() / params.time->end);
  if (eta.discretization <= share) return false;
  if (const auto errors = evolution.step_errors(); errors && errors->time > errors->space) {
    outcome.steps_too_long = true;
    return false;
  }
  const AdaptParams adapt = params.adapt.value_or(AdaptParams());
  const auto& hierarchy = *evolution.hierarchy();
  const int added = static_cast<int>(hierarchy.levels.size()) - 1 - params.mesh.refinements;
  outcome.refinement_limited = true;
  if (added >= adapt.max_levels || evolution.sizes().unknowns_all >= adapt.max_unknowns) return false;
  const auto marked = refinable(hierarchy.finest(), mark(hierarchy.finest(), adapt, evolution.cell_estimates().discretization));
  outcome.refinement_limited = false;
  if (marked.empty()) return false;
  outcome.X = evolution.refine(marked, *outcome.X);
  outcome.active = {};
  if (observer.refined) observer.refined(outcome.at, static_cast<GlobalIndex>(marked.size()), evolution);
  return true;
}

}  // namespace thixis::drive
