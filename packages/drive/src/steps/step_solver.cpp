#include "steps/step_solver.hpp"

#include <algorithm>
#include <cmath>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {
namespace {

using algebra::Vector;

constexpr double tighter = 1e-2;  ///< tolerances of a solver that has to go on
constexpr int most_tightenings = 3, most_further_steps = 10;

}  // namespace

bool StepSolver::operator()(const models::TimeStep& step, Vector& X) {
  bool ahead = false;
  {
    const core::Region region("assembly");
    evolution_.begin(step, *outcome_.X);
    ahead = evolution_.predict(X);
  }
  if (solve(step, X)) return true;
  if (!ahead) return false;
  retry(step, "from the predicted start: " + outcome_.last.why, step.length());
  Tpetra::deep_copy(X, *outcome_.X);
  return solve(step, X);
}

bool StepSolver::solve(const models::TimeStep& step, Vector& X) {
  complementarity::NewtonParams newton = params_.newton;
  newton.sweeps = params_.newton.sweeps.value_or(0);
  complementarity::StoppingParams stopping = params_.stopping;
  stopping.absolute_tolerance += evolution_.round_off();
  refused_ = false;
  iterate(step, newton, stopping, X);
  if (!outcome_.last.converged || !std::isfinite(algebra::norm2(X))) return false;
  models::Objection objection = objection_to(X);
  for (int more = 0; objection.too_loose && more < most_tightenings; ++more) {
    newton.max_iterations = std::min(params_.newton.max_iterations, most_further_steps);
    if (!tighten(step, newton, stopping, X)) break;
    objection = objection_to(X);
  }
  if (objection) return refuse(objection);
  if (params_.estimated()) eta_ = estimate_at_end(evolution_, outcome_.last, X);
  return true;
}

void StepSolver::iterate(const models::TimeStep& step, const complementarity::NewtonParams& newton,
                         const complementarity::StoppingParams& stopping, Vector& X) {
  outcome_.last = complementarity::newton(evolution_.problem(), X, newton, stopping, params_.linear.check_every, on_step(step.end),
                                          [this](const Vector& now) { return look_(evolution_, now); });
  outcome_.at.newton_iterations += outcome_.last.steps;
  outcome_.at.linear_iterations += outcome_.last.linear_iterations;
}

/// Goes on from X with smaller tolerances; false where the solver can not. Tolerances relative to the data may be loose where a step
/// moves little of what is there, or rows differ in size.
bool StepSolver::tighten(const models::TimeStep& step, const complementarity::NewtonParams& newton,
                         complementarity::StoppingParams& stopping, Vector& X) {
  for (double* tolerance : {&stopping.linear_tolerance, &stopping.nonlinear_tolerance, &stopping.absolute_tolerance}) *tolerance *= tighter;
  const complementarity::NewtonReport before = outcome_.last;
  const Vector start(X, Teuchos::Copy);
  iterate(step, newton, stopping, X);
  const bool converged = outcome_.last.converged && std::isfinite(algebra::norm2(X));
  outcome_.last.steps += before.steps;
  outcome_.last.linear_iterations += before.linear_iterations;
  if (converged) return true;
  Tpetra::deep_copy(X, start);
  return false;
}

/// What the model has against that which the nonlinear solver takes for a solution.
models::Objection StepSolver::objection_to(const Vector& X) {
  const core::Region region("verification");
  const bool conditions = params_.stopping.rule != complementarity::StoppingRule::adaptive;
  return evolution_.objection(X, kkt_tolerance(complementarity::KktData()), conditions);
}

bool StepSolver::refuse(const models::Objection& objection) {
  refused_ = true;
  outcome_.last.converged = false;
  outcome_.last.why = objection.why;
  return false;
}

double StepSolver::kkt_tolerance(const complementarity::KktData& data) {
  return drive::kkt_tolerance(evolution_, params_.stopping, data, *outcome_.X, evolution_.round_off());
}

StepRecord StepSolver::record(const models::TimeStep& step, double seconds) const {
  StepRecord record;
  record.at = outcome_.at;
  record.length = step.length();
  record.newton = outcome_.last.steps;
  record.linear = outcome_.last.linear_iterations;
  record.active = outcome_.last.active;
  record.residual = outcome_.last.residuals.back();
  record.energy_error = evolution_.error_so_far();
  if (params_.estimated()) record.of_step = eta_;
  record.so_far = evolution_.estimate_so_far();
  record.seconds = seconds;
  return record;
}

/// Sentences of the model say themselves what to try.
std::string StepSolver::advice() const {
  if (refused_) return "";
  return outcome_.last.advice.empty() ? "Try a smaller stopping/linear tolerance or newton/globalization = hybrid." : outcome_.last.advice;
}

void StepSolver::retry(const models::TimeStep& step, const std::string& why, double next) {
  ++outcome_.at.retries;
  if (observer_.retry) observer_.retry(outcome_.at, step.length(), why, next);
}

complementarity::NewtonObserver StepSolver::on_step(double end) {
  complementarity::NewtonObserver newton;
  newton.message = observer_.message;
  if (observer_.newton)
    newton.step = [this, end](const complementarity::NewtonRecord& record) {
      observer_.newton(outcome_.at, end, record, look_.error(record.estimate));
    };
  if (observer_.check)
    newton.linear = [this, end](const complementarity::LinearRecord& record) {
      observer_.check(outcome_.at, end, record, look_.error(record.estimate));
    };
  return newton;
}

}  // namespace thixis::drive
