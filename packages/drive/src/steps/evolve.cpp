#include "thixis/drive/evolve.hpp"

#include <fmt/format.h>

#include <cmath>

#include "refine/marking.hpp"
#include "restart/evolution_checkpoint.hpp"
#include "steps/step_control.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {
namespace {

using algebra::Vector;

constexpr double unseen = 0.1;  ///< part of the bound so far, in proportion to the time: a hundredth of its square

constexpr double tighter = 1e-2;  ///< tolerances of a solver that has to go on
constexpr int most_tightenings = 3, most_further_steps = 10;

/// The run from step to step.
class Run {
 public:
  Run(models::Evolution& evolution, const RunParams& params, const EvolutionObserver& observer)
      : evolution_(evolution), params_(params), time_(*params.time), observer_(observer), control_(time_, evolution.jumps()) {}

  EvolutionOutcome from(const output::StoredCheckpoint* stored) {
    out_.not_wanted = params_.newton.max_iterations == 0;
    begin(out_.not_wanted ? nullptr : stored);
    while (!out_.not_wanted && !at_end() && advanced() && !told_to_end()) {
    }
    out_.solved = at_end();
    out_.next_length = control_.length();
    if (took_steps_ && at_its_end_) verify();
    return std::move(out_);
  }

 private:
  bool at_end() const { return out_.at.time >= time_.end; }

  void begin(const output::StoredCheckpoint* stored) {
    const core::Region region("assembly");
    if (stored) {
      const StoredEvolution from = stored_evolution(*stored);
      out_.at = from.at;
      control_.set_length(from.next_length);
      out_.X = evolution_.restore(*stored);
      return;
    }
    out_.X = evolution_.initial();
    if (out_.not_wanted || !observer_.step) return;
    StepRecord record;
    record.energy_error = evolution_.error_so_far();
    observer_.step(record, evolution_, *out_.X, {});
  }

  bool told_to_end() {
    if (observer_.stop) out_.stopped = observer_.stop(out_.at, control_.length(), evolution_, *out_.X);
    return !out_.stopped.empty();
  }

  /// One accepted step; false if that is not possible. Steps before one whose data are wrong are kept.
  bool advanced() {
    try {
      if (advance()) return true;
      give_up();
    } catch (const core::InputError& error) {
      give_up();
      if (out_.at.step == 0) throw;
      out_.mistake = error.what();
    }
    return false;
  }

  /// X is at the begin of the step under way.
  void give_up() {
    if (at_its_end_) return;
    const core::Region region("assembly");
    evolution_.give_up();
  }

  /// Each turn makes the step shorter, but not below time/smallest, or the mesh finer, as far as `adapt` allows.
  bool advance() {
    const core::Stopwatch clock;
    for (bool again = false;; again = true) {
      if (again) {
        give_up();
        if (told_to_end()) return false;
      }
      const models::TimeStep step{out_.at.time, control_.end_of_step(out_.at.time)};
      const auto X = Teuchos::rcp(new Vector(*out_.X, Teuchos::Copy));
      if (!attempt(step, *X)) {
        if (!cut(step)) return false;
        continue;
      }
      std::optional<models::StepErrors> errors;
      if (params_.estimated()) {
        if (finer_mesh(step)) continue;
        errors = errors_of(step);
        if (errors && control_.too_long(step.length(), *errors)) {
          retry(step, fmt::format("the error in time {:.2e} is large beside that in space, {:.2e}", errors->time, errors->space));
          continue;
        }
      }
      accept(step, X, errors, clock.seconds());
      return true;
    }
  }

  /// What the step may add to the bound without being seen in it counts for nothing.
  std::optional<models::StepErrors> errors_of(const models::TimeStep& step) const {
    auto errors = evolution_.step_errors();
    const auto so_far = evolution_.estimate_so_far();
    if (errors && so_far) errors->negligible = std::max(errors->negligible, unseen * so_far->total * std::sqrt(step.length() / step.end));
    return errors;
  }

  /// Newton from a prediction or, where there is none or it leads nowhere, from the state before; false if it fails.
  bool attempt(const models::TimeStep& step, Vector& X) {
    bool ahead = false;
    {
      const core::Region region("assembly");
      at_its_end_ = false;
      evolution_.begin(step, *out_.X);
      ahead = evolution_.predict(X);
    }
    if (solve(step, X)) return true;
    if (!ahead) return false;
    retry(step, "from the predicted start: " + out_.last.why, step.length());
    Tpetra::deep_copy(X, *out_.X);
    return solve(step, X);
  }

  bool solve(const models::TimeStep& step, Vector& X) {
    complementarity::NewtonParams newton = params_.newton;
    newton.sweeps = params_.newton.sweeps.value_or(0);
    complementarity::StoppingParams stopping = params_.stopping;
    stopping.absolute_tolerance += evolution_.round_off();
    refused_ = false;
    iterate(step, newton, stopping, X);
    if (!out_.last.converged || !std::isfinite(algebra::norm2(X))) return false;
    models::Objection objection = objection_to(X);
    for (int more = 0; objection.too_loose && more < most_tightenings; ++more) {
      newton.max_iterations = std::min(params_.newton.max_iterations, most_further_steps);
      if (!tighten(step, newton, stopping, X)) break;
      objection = objection_to(X);
    }
    if (objection) return refuse(objection);
    if (params_.estimated()) {
      const core::Region region("estimate");
      eta_ = out_.last.estimate ? *out_.last.estimate : evolution_.estimate(X);
    }
    return true;
  }

  void iterate(const models::TimeStep& step, const complementarity::NewtonParams& newton, const complementarity::StoppingParams& stopping,
               Vector& X) {
    out_.last = complementarity::newton(evolution_.problem(), X, newton, stopping, params_.linear.check_every, on_step(step.end),
                                        [this](const Vector& now) { return look(now); });
    out_.at.newton_iterations += out_.last.steps;
    out_.at.linear_iterations += out_.last.linear_iterations;
  }

  /// Goes on from X with smaller tolerances; false where the solver can not. Tolerances relative to the data may be loose where a step
  /// moves little of what is there, or rows differ in size.
  bool tighten(const models::TimeStep& step, const complementarity::NewtonParams& newton, complementarity::StoppingParams& stopping,
               Vector& X) {
    for (double* tolerance : {&stopping.linear_tolerance, &stopping.nonlinear_tolerance, &stopping.absolute_tolerance})
      *tolerance *= tighter;
    const complementarity::NewtonReport before = out_.last;
    const Vector start(X, Teuchos::Copy);
    iterate(step, newton, stopping, X);
    const bool converged = out_.last.converged && std::isfinite(algebra::norm2(X));
    out_.last.steps += before.steps;
    out_.last.linear_iterations += before.linear_iterations;
    if (converged) return true;
    Tpetra::deep_copy(X, start);
    return false;
  }

  /// The estimate at an iterate, and, for the history, its error.
  complementarity::Estimate look(const Vector& iterate) {
    const auto estimate = evolution_.estimate(iterate);
    const core::Region region("verification");
    if (params_.output.history) error_at_look_ = evolution_.energy_error(iterate);
    return estimate;
  }

  /// What the model has against that which the nonlinear solver takes for a solution.
  models::Objection objection_to(const Vector& X) {
    const core::Region region("verification");
    const bool conditions = params_.stopping.rule != complementarity::StoppingRule::adaptive;
    return evolution_.objection(X, kkt_tolerance(complementarity::KktData()), conditions);
  }

  bool refuse(const models::Objection& objection) {
    refused_ = true;
    out_.last.converged = false;
    out_.last.why = objection.why;
    return false;
  }

  /// Of the deck, or what the tolerance of the nonlinear solver allows.
  double kkt_tolerance(const complementarity::KktData& data) {
    const complementarity::Problem& problem = evolution_.problem();
    const double rounding = evolution_.round_off() + problem.noise(*out_.X);
    const double residual = params_.stopping.nonlinear_residual(problem.reference_norm(), rounding);
    return params_.stopping.kkt_tolerance.value_or(data.allowed(residual));
  }

  bool cut(const models::TimeStep& step) {
    if (control_.cut(step.length())) {
      retry(step, out_.last.why);
      return true;
    }
    ++out_.at.retries;
    out_.why = fmt::format("the step from time {:.6g} to {:.6g} failed, and shorter ones would be below time/smallest = {:.3g}: {} {}",
                           step.begin, step.end, control_.smallest(), out_.last.why, refused_ ? "" : advice() + " ") +
               "Or allow a smaller time/smallest.";
    return false;
  }

  /// Sentences of the model say themselves what to try.
  std::string advice() const {
    return out_.last.advice.empty() ? "Try a smaller stopping/linear tolerance or newton/globalization = hybrid." : out_.last.advice;
  }

  void retry(const models::TimeStep& step, const std::string& why) { retry(step, why, control_.length()); }
  void retry(const models::TimeStep& step, const std::string& why, double next) {
    ++out_.at.retries;
    if (observer_.retry) observer_.retry(out_.at, step.length(), why, next);
  }

  /// Whether the mesh was refined because the share of the step in the error is too large.
  bool finer_mesh(const models::TimeStep& step) {
    if (!params_.stopping.target || !evolution_.hierarchy()) return false;
    const double share = *params_.stopping.target * std::sqrt(step.length() / time_.end);
    if (eta_->discretization <= share) return false;
    if (const auto errors = evolution_.step_errors(); errors && errors->time > errors->space) {
      out_.steps_too_long = true;
      return false;
    }
    const AdaptParams adapt = params_.adapt.value_or(AdaptParams());
    const auto& hierarchy = *evolution_.hierarchy();
    const int added = static_cast<int>(hierarchy.levels.size()) - 1 - params_.mesh.refinements;
    out_.refinement_limited = true;
    if (added >= adapt.max_levels || evolution_.sizes().unknowns_all >= adapt.max_unknowns) return false;
    const auto marked = refinable(hierarchy.finest(), mark(hierarchy.finest(), adapt, evolution_.cell_estimates().discretization));
    out_.refinement_limited = false;
    if (marked.empty()) return false;
    out_.X = evolution_.refine(marked, *out_.X);
    out_.active = {};
    control_.forget();
    if (observer_.refined) observer_.refined(out_.at, static_cast<GlobalIndex>(marked.size()), evolution_);
    return true;
  }

  void accept(const models::TimeStep& step, const Teuchos::RCP<Vector>& X, const std::optional<models::StepErrors>& errors,
              double seconds) {
    {
      const core::Region region("verification");
      evolution_.accept(*X);
    }
    if (const auto remark = evolution_.remark(); !remark.empty() && !remarked_ && observer_.message) {
      observer_.message(remark);
      remarked_ = true;
    }
    at_its_end_ = true;
    control_.accept(step.length(), errors);
    out_.X = X;
    out_.active = out_.last.active_set;
    ++out_.at.step;
    took_steps_ = true;
    out_.at.time = step.end;
    if (!observer_.step) return;
    StepRecord record;
    record.at = out_.at;
    record.length = step.length();
    record.newton = out_.last.steps;
    record.linear = out_.last.linear_iterations;
    record.active = out_.last.active;
    record.residual = out_.last.residuals.back();
    record.energy_error = evolution_.error_so_far();
    if (params_.estimated()) record.of_step = eta_;
    record.so_far = evolution_.estimate_so_far();
    record.seconds = seconds;
    observer_.step(record, evolution_, *X, out_.last.active_set);
  }

  void verify() {
    const core::Region region("verification");
    const auto data = evolution_.kkt_data(*out_.X);
    out_.kkt = complementarity::verify(data);
    out_.kkt_tolerance = kkt_tolerance(data);
  }

  complementarity::NewtonObserver on_step(double end) {
    complementarity::NewtonObserver newton;
    newton.message = observer_.message;
    if (observer_.newton)
      newton.step = [this, end](const complementarity::NewtonRecord& record) {
        observer_.newton(out_.at, end, record, record.estimate ? error_at_look_ : std::nullopt);
      };
    if (observer_.check)
      newton.linear = [this, end](const complementarity::LinearRecord& record) {
        observer_.check(out_.at, end, record, record.estimate ? error_at_look_ : std::nullopt);
      };
    return newton;
  }

  models::Evolution& evolution_;
  const RunParams& params_;
  const TimeParams& time_;
  const EvolutionObserver& observer_;
  StepControl control_;
  EvolutionOutcome out_;
  bool took_steps_ = false;
  bool refused_ = false;                          ///< the last attempt ended with an objection of the model
  bool remarked_ = false;                         ///< one remark is enough
  bool at_its_end_ = true;                        ///< X is the end of the step that the evolution knows of, not its begin
  std::optional<double> error_at_look_;           ///< of the step, where its estimate was asked for last
  std::optional<complementarity::Estimate> eta_;  ///< of the last attempt, where the error is estimated
};

}  // namespace

EvolutionOutcome evolve(models::Evolution& evolution, const RunParams& params, const EvolutionObserver& observer,
                        const output::StoredCheckpoint* stored) {
  return Run(evolution, params, observer).from(stored);
}

}  // namespace thixis::drive
