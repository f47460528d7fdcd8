#include "judge/verdict.hpp"

#include <fmt/format.h>

namespace thixis::drive {

using core::ExitCode;

std::string effort_clause(const Effort& effort) {
  return fmt::format("{} Newton step{} and {} Krylov iteration{}", effort.newton_iterations, effort.newton_iterations == 1 ? "" : "s",
                     effort.linear_iterations, effort.linear_iterations == 1 ? "" : "s");
}

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

std::string contact_clause(const complementarity::Kkt& kkt, double tolerance) {
  const char* unjudged = kkt.holds(tolerance) ? "" : ", which the rule adaptive does not judge";
  return fmt::format("contact conditions hold to {:.1e}{}", kkt.worst(), unjudged);
}

std::string not_in_contact(const RunParams& params, const complementarity::NewtonReport& newton,
                           const std::optional<complementarity::Kkt>& kkt, double tolerance) {
  if (params.stopping.rule == complementarity::StoppingRule::adaptive || !kkt || kkt->holds(tolerance)) return "";
  return fmt::format(
      "not converged: Newton stopped. {} But: {} Try linear/solver = direct or a smaller stopping/linear tolerance, a smaller "
      "stopping/nonlinear tolerance, or newton/globalization = hybrid.",
      newton.why, kkt->sentence(tolerance));
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

}  // namespace thixis::drive
