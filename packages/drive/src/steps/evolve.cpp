#include "thixis/drive/evolve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "restart/stored.hpp"
#include "steps/refined.hpp"
#include "steps/step_control.hpp"
#include "steps/step_solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {
namespace {

using algebra::Vector;

constexpr double unseen = 0.1;  ///< part of the bound so far, in proportion to the time: a hundredth of its square

/// The run from step to step.
class Run {
 public:
  Run(models::Evolution& evolution, const RunParams& params, const EvolutionObserver& observer)
      : evolution_(evolution),
        params_(params),
        time_(*params.time),
        observer_(observer),
        control_(time_, evolution.jumps()),
        solve_(evolution, params, observer, out_) {}

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
      at_its_end_ = false;
      if (!solve_(step, *X)) {
        if (!cut(step)) return false;
        continue;
      }
      std::optional<models::StepErrors> errors;
      if (params_.estimated()) {
        if (finer_mesh(step)) continue;
        errors = errors_of(step);
        if (errors && control_.too_long(step.length(), *errors)) {
          solve_.retry(step, fmt::format("the error in time {:.2e} is large beside that in space, {:.2e}", errors->time, errors->space),
                       control_.length());
          continue;
        }
      }
      accept(step, X, errors, clock.seconds());
      return true;
    }
  }

  /// A step that is begun again for its mesh is so for another reason than its length.
  bool finer_mesh(const models::TimeStep& step) {
    if (!refined(evolution_, params_, step, *solve_.estimate(), out_, observer_)) return false;
    control_.forget();
    return true;
  }

  /// What the step may add to the bound without being seen in it counts for nothing.
  std::optional<models::StepErrors> errors_of(const models::TimeStep& step) const {
    auto errors = evolution_.step_errors();
    const auto so_far = evolution_.estimate_so_far();
    if (errors && so_far) errors->negligible = std::max(errors->negligible, unseen * so_far->total * std::sqrt(step.length() / step.end));
    return errors;
  }

  bool cut(const models::TimeStep& step) {
    if (control_.cut(step.length())) {
      solve_.retry(step, out_.last.why, control_.length());
      return true;
    }
    ++out_.at.retries;
    const std::string advice = solve_.advice();
    out_.why = fmt::format("the step from time {:.6g} to {:.6g} failed, and shorter ones would be below time/smallest = {:.3g}: {} {}",
                           step.begin, step.end, control_.smallest(), out_.last.why, advice.empty() ? "" : advice + " ") +
               "Or allow a smaller time/smallest.";
    return false;
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
    if (observer_.step) observer_.step(solve_.record(step, seconds), evolution_, *X, out_.last.active_set);
  }

  void verify() {
    const core::Region region("verification");
    const auto data = evolution_.kkt_data(*out_.X);
    out_.kkt = complementarity::verify(data);
    out_.kkt_tolerance = solve_.kkt_tolerance(data);
  }

  models::Evolution& evolution_;
  const RunParams& params_;
  const TimeParams& time_;
  const EvolutionObserver& observer_;
  StepControl control_;
  EvolutionOutcome out_;
  StepSolver solve_;
  bool took_steps_ = false;
  bool remarked_ = false;   ///< one remark is enough
  bool at_its_end_ = true;  ///< X is the end of the step that the evolution knows of, not its begin
};

}  // namespace

EvolutionOutcome evolve(models::Evolution& evolution, const RunParams& params, const EvolutionObserver& observer,
                        const output::StoredCheckpoint* stored) {
  return Run(evolution, params, observer).from(stored);
}

}  // namespace thixis::drive
