#include "judge/verdict_in_time.hpp"

#include <fmt/format.h>

#include <cmath>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::drive {

const char* const not_bounded =
    "steps before the checkpoint ran without stopping/estimate = true, so that their share in the error is unknown";

namespace {

/// Where most of a bound comes from the lengths of the steps, it says nothing of the mesh. No number: `time` is a sum of roots, the bound
/// the root of a sum, and the part may be larger than the whole.
std::string time_decides(const complementarity::Estimate& bound) {
  if (!(bound.time.value_or(0) > 0.7 * bound.total)) return "";
  return ", most of it for the lengths of the steps: shorter ones (time/step) make it smaller, a finer mesh does not";
}

/// What is known of the error and of the solution, in clauses.
std::string qualities(const RunParams& params, const models::Evolution& evolution, const EvolutionOutcome& outcome) {
  std::string clauses;
  const auto error = evolution.error_so_far();
  if (error) clauses += fmt::format("; energy error {:.4e}", *error);
  if (params.estimated() && !evolution.every_step_estimated()) clauses += fmt::format("; no bound on the error: {}", not_bounded);
  if (const auto bound = evolution.estimate_so_far()) {
    const double norm = std::sqrt(outcome.at.time) * evolution.energy_norm(*outcome.X);
    clauses += "; " + bound_clause(evolution.bound_name(), *bound) + contradiction(*bound, error, norm) + time_decides(*bound);
  }
  for (const models::Balance& balance : evolution.balances())
    clauses += fmt::format("; {} balanced to {:.1e} in every step", balance.name, balance.worst_step);
  if (outcome.kkt) clauses += "; " + contact_clause(*outcome.kkt, outcome.kkt_tolerance);
  return clauses;
}

std::string effort(const TimePosition& at) {
  return fmt::format("{} time step{}, {}", at.step, at.step == 1 ? "" : "s", effort_clause(at)) +
         (at.retries > 0 ? fmt::format(" ({} attempt{} given up)", at.retries, at.retries == 1 ? "" : "s") : "");
}

std::string interrupted(const RunParams& params, const EvolutionOutcome& outcome) {
  if (outcome.stopped.empty()) return "";
  return fmt::format("{} at time {:.6g} of {:.6g}, after {}.", outcome.stopped, outcome.at.time, params.time->end, effort(outcome.at));
}

std::string mistaken(const RunParams& params, const core::Deck& deck, const EvolutionOutcome& outcome) {
  if (outcome.mistake.empty()) return "";
  return fmt::format("solved up to time {:.6g} of {:.6g}, in {}; then: {}", outcome.at.time, params.time->end, effort(outcome.at),
                     deck.located(core::InputError(outcome.mistake)).what());
}

std::string failed(const RunParams& params, const EvolutionOutcome& outcome) {
  if (!outcome.solved) return "not converged: " + outcome.why;
  return not_in_contact(params, outcome.last, outcome.kkt, outcome.kkt_tolerance);
}

std::string target_missed(const RunParams& params, const models::Evolution& evolution, const EvolutionOutcome& outcome) {
  if (!params.stopping.target) return "";
  const auto bound = evolution.estimate_so_far();
  if (!bound) return fmt::format("stopping/target = {:g} can not be judged: {}", *params.stopping.target, not_bounded);
  if (bound->total <= *params.stopping.target) return "";
  return fmt::format(
      "target missed: {}, not {:g}{}{}", bound_clause(evolution.bound_name(), *bound), *params.stopping.target,
      outcome.refinement_limited
          ? "; adapt/max levels or adapt/max unknowns kept the mesh from becoming finer: allow more, or take a higher method/degree"
          : "",
      outcome.steps_too_long ? "; most of it is for the lengths of the steps: take shorter ones (time/step)" : "");
}

}  // namespace

Ending ending(const RunParams& params, const models::Evolution& evolution, const core::Deck& deck, const EvolutionOutcome& outcome) {
  Ending ending;
  ending.not_wanted = outcome.not_wanted;
  if (ending.not_wanted) return ending;
  ending.interrupted = interrupted(params, outcome);
  ending.mistaken = mistaken(params, deck, outcome);
  if (!ending.interrupted.empty() || !ending.mistaken.empty()) return ending;
  ending.failed = failed(params, outcome);
  if (!ending.failed.empty()) return ending;
  ending.target = target_missed(params, evolution, outcome);
  ending.solved = fmt::format("solved in {}{}.", effort(outcome.at), qualities(params, evolution, outcome));
  return ending;
}

}  // namespace thixis::drive
