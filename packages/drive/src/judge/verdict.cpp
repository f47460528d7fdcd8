#include "judge/verdict.hpp"

#include <fmt/format.h>

#include "judge/expectations.hpp"

namespace thixis::drive {
namespace {

using core::ExitCode;

std::string bound(const Outcome& outcome) { return bound_clause("energy error at most", *outcome.estimate); }

/// "3 Newton steps and 20 Krylov iterations".
std::string effort(const Position& at) {
  return fmt::format("{} Newton step{} and {} Krylov iteration{}", at.newton_iterations, at.newton_iterations == 1 ? "" : "s",
                     at.linear_iterations, at.linear_iterations == 1 ? "" : "s");
}

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
  std::string sentence = "solved in " + effort(outcome.at);
  if (!outcome.finest.settled) sentence += "; the contact set did not settle; ended by its residual";
  if (outcome.energy_error) sentence += fmt::format("; energy error {:.4e}", *outcome.energy_error);
  if (outcome.estimate) sentence += "; " + bound(outcome) + contradiction(*outcome.estimate, outcome.energy_error, outcome.energy_norm);
  if (params.stopping.target) sentence += fmt::format(", as asked for by stopping/target = {:g}", *params.stopping.target);
  else if (!outcome.refinement_ended.empty()) sentence += "; refinement ended by " + outcome.refinement_ended;
  const char* unjudged = outcome.kkt->holds(outcome.kkt_tolerance) ? "" : ", which the rule adaptive does not judge";
  return sentence + fmt::format("; contact conditions hold to {:.1e}{}{}.", outcome.kkt->worst(), unjudged, rounded(outcome.rounding));
}

std::string target_missed(const RunParams& params, const Outcome& outcome) {
  return fmt::format("target missed: {}, not {:g}; refinement ended by {}; {}", bound(outcome), *params.stopping.target,
                     outcome.refinement_ended, outcome.to_try);
}

std::string failed(const RunParams& params, const Outcome& outcome) {
  if (!outcome.solved) return not_converged(outcome.finest);
  if (params.stopping.rule != complementarity::StoppingRule::adaptive && !outcome.kkt->holds(outcome.kkt_tolerance))
    return not_in_contact(outcome.finest, *outcome.kkt, outcome.kkt_tolerance);
  return outcome.rounding.of_contact > too_much ? hidden(outcome.rounding) : "";
}

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

}  // namespace

std::string bound_clause(const std::string& name, const complementarity::Estimate& eta) {
  return fmt::format("{} {:.4e} ({})", name, eta.total, to_text(eta.promise));
}

std::string contradiction(const complementarity::Estimate& eta, std::optional<double> error, double norm) {
  constexpr double integrals = 1e-3, differences = 1e-8;  // relative errors of what is called the error
  if (!error || *error <= (1 + integrals) * eta.total + differences * norm) return "";
  switch (eta.promise) {
    case complementarity::Promise::guaranteed:
      return ", less than the error: the exact solution does not fit the data, or not the polygon that the mesh is";
    case complementarity::Promise::up_to_quadrature:
      return ", less than the error: quadrature does not see all of the data, or the exact solution does not fit them";
    default:
      return "";
  }
}

std::string not_converged(const complementarity::NewtonReport& newton) {
  return "not converged: " + newton.why + (newton.advice.empty() ? "" : " " + newton.advice);
}

std::string not_in_contact(const complementarity::NewtonReport& newton, const complementarity::Kkt& kkt, double tolerance) {
  return fmt::format(
      "not converged: Newton stopped. {} But: {} Try linear/solver = direct or a smaller stopping/linear tolerance, a smaller "
      "stopping/nonlinear tolerance, or newton/globalization = hybrid.",
      newton.why, kkt.sentence(tolerance));
}

Verdict judge(const Ending& ending, const std::vector<std::string>& missed) {
  const std::string clauses = fmt::format("{}", fmt::join(missed, "; "));
  if (ending.not_wanted) {
    if (!missed.empty()) return {ExitCode::target_missed, "not solved (max iterations = 0), and not as expected: " + clauses + "."};
    return {ExitCode::done, "not solved: max iterations = 0 only counts the unknowns."};
  }
  if (!ending.interrupted.empty()) return {ExitCode::interrupted, ending.interrupted};
  if (!ending.mistaken.empty()) return {ExitCode::input, ending.mistaken};
  if (!ending.failed.empty()) return {ExitCode::not_converged, ending.failed};
  if (!ending.target.empty())
    return {ExitCode::target_missed, ending.target + (missed.empty() ? "" : "; besides, not as expected: " + clauses) + "."};
  if (!missed.empty()) return {ExitCode::target_missed, "solved, but not as expected: " + clauses + "."};
  return {ExitCode::done, ending.solved};
}

Verdict judge(const RunParams& params, const Outcome& outcome) {
  return judge(ending(params, outcome), missed(params.expect, found(outcome)));
}

}  // namespace thixis::drive
