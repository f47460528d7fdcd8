#include "judge/verdict_at_rest.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "judge/expectations.hpp"

namespace thixis::drive {
namespace {

std::string bound(const Outcome& outcome) { return bound_clause("energy error at most", *outcome.estimate); }

/// Relative to what acts: from here on rounding is worth a word, and from there on contact is not known.
constexpr double noticeable = 1e-6, too_much = 1e-2;

constexpr const char* spread_less =
    "subtract from all heights what they have in common, such as a tilt, and put what never touches less far away";

std::string hidden(const models::Rounding& rounding) {
  return fmt::format(
      "not converged: the rounding of heights of up to {:.1e} is {:.1e} of what drives the gap, so that contact cannot be told; {}.",
      rounding.height, rounding.of_contact, spread_less);
}

std::string rounded(const models::Rounding& rounding) {
  const double share = std::max(rounding.of_contact, rounding.of_forces);
  if (share <= noticeable) return "";
  return fmt::format("; the rounding of heights of up to {:.1e} hides forces below {:.1e} of those that act: {}", rounding.height, share,
                     spread_less);
}

std::string solved(const RunParams& params, const Outcome& outcome) {
  std::string sentence = "solved in " + effort_clause(outcome.at);
  if (!outcome.finest.settled) sentence += "; the contact set did not settle; ended by its residual";
  if (outcome.energy_error) sentence += fmt::format("; energy error {:.4e}", *outcome.energy_error);
  if (outcome.estimate) sentence += "; " + bound(outcome) + contradiction(*outcome.estimate, outcome.energy_error, outcome.energy_norm);
  if (params.stopping.target) sentence += fmt::format(", as asked for by stopping/target = {:g}", *params.stopping.target);
  else if (!outcome.refinement_ended.empty()) sentence += "; refinement ended by " + outcome.refinement_ended;
  return sentence + "; " + contact_clause(*outcome.kkt, outcome.kkt_tolerance) + rounded(outcome.rounding) + ".";
}

std::string target_missed(const RunParams& params, const Outcome& outcome) {
  return fmt::format("target missed: {}, not {:g}; refinement ended by {}; {}", bound(outcome), *params.stopping.target,
                     outcome.refinement_ended, outcome.to_try);
}

std::string not_converged(const complementarity::NewtonReport& newton) {
  return "not converged: " + newton.why + (newton.advice.empty() ? "" : " " + newton.advice);
}

std::string failed(const RunParams& params, const Outcome& outcome) {
  if (!outcome.solved) return not_converged(outcome.finest);
  std::string why = not_in_contact(params, outcome.finest, outcome.kkt, outcome.kkt_tolerance);
  if (why.empty() && outcome.rounding.of_contact > too_much) why = hidden(outcome.rounding);
  return why;
}

}  // namespace

Ending ending(const RunParams& params, const Outcome& outcome) {
  Ending ending;
  ending.not_wanted = outcome.not_wanted;
  if (ending.not_wanted) return ending;
  ending.failed = failed(params, outcome);
  if (!ending.failed.empty()) return ending;
  if (params.stopping.target && !outcome.refinement_ended.empty()) ending.target = target_missed(params, outcome);
  else ending.solved = solved(params, outcome);
  return ending;
}

Verdict judge(const RunParams& params, const Outcome& outcome) {
  return judge(ending(params, outcome), missed(params.expect, found(outcome)));
}

}  // namespace thixis::drive
