#include "follow/follow_evolution.hpp"

#include <fmt/format.h>

#include <Teuchos_RCP.hpp>

#include "follow/interrupt.hpp"
#include "follow/results.hpp"

namespace thixis::drive {
namespace log = core::log;

FollowEvolution::FollowEvolution(const output::RunDirectory& directory, const RunParams& params, const models::Evolution& evolution,
                                 CheckpointFile& checkpoint, const Written& before, double first_time)
    : Follower(directory, params, evolution.comm(), checkpoint, before),
      last_frame_(before.frames > 0 ? before.last_frame : -1),
      first_time_(first_time),
      progress_("time") {
  if (const auto names = evolution.series_names(); !names.empty())
    series_.emplace(output::Series::go_on(directory.series(), names, before.series_rows, evolution.comm()));
  if (!params.output.no_fields()) fields_.emplace(output::FieldWriter::series(directory.path(), evolution.comm(), before.frames));
  begin_table();
}

EvolutionObserver FollowEvolution::observer() {
  EvolutionObserver observer;
  observer.newton = [this](const TimePosition& at, double end, const complementarity::NewtonRecord& record, std::optional<double> error) {
    newton(at, end, record, error);
  };
  if (sees_linear_iterates())
    observer.check = [this](const TimePosition& at, double end, const complementarity::LinearRecord& record, std::optional<double> error) {
      check(at, end, record, error);
    };
  observer.retry = [this](const TimePosition& at, double length, const std::string& why, double next) { retry(at, length, why, next); };
  observer.refined = [](const TimePosition& at, GlobalIndex marked, const models::Evolution& evolution) {
    log::info("{:>6}  {} cells were refined: {} cells, {} unknowns", at.step + 1, marked, evolution.cells(),
              evolution.sizes().unknowns_all);
  };
  observer.step = [this](const StepRecord& record, const models::Evolution& evolution, const algebra::Vector& X,
                         const complementarity::ActiveSet& active) { step(record, evolution, X, active); };
  observer.stop = [this](const TimePosition& at, double next_length, const models::Evolution& evolution, const algebra::Vector& X) {
    return stop(at, next_length, evolution, X);
  };
  observer.message = [](const std::string& sentence) { log::warn("{}", sentence); };
  return observer;
}

void FollowEvolution::begin_table() const {
  log::info("{:>6}{:>13}{:>11}{:>8}{:>8}{:>10}{:>13}{}", "step", "time", "length", "Newton", "Krylov", "active", "residual",
            params_.estimated() ? estimate_header() : "");
}

void FollowEvolution::step(const StepRecord& record, const models::Evolution& evolution, const algebra::Vector& X,
                           const complementarity::ActiveSet& active) {
  const TimePosition& at = record.at;
  if (at.step > 0) {
    log::info("{:>6}{:>13.6g}{:>11.4g}{:>8}{:>8}{:>10}{:>13.4e}{}", at.step, at.time, record.length, record.newton, record.linear,
              record.active.value_or(0), record.residual.value_or(0), estimate_columns(record.of_step));
    output::HistoryRow now = row(record.so_far, record.energy_error);
    now.time_step = at.step;
    now.time = at.time;
    now.active = record.active;
    history_.append(now);
  }
  estimated_ = record.of_step.has_value();
  if (series_) series_->append(at.time, evolution.series(X));
  if (at.step % params_.output.fields_every == 0) show(at.step, at.time, evolution, X, active);
  const double whole = params_.time->end - first_time_;
  progress_.update(whole > 0 ? (at.time - first_time_) / whole : 1, fmt::format("t = {:.6g}", at.time));
}

void FollowEvolution::show(int step, double time, const models::Evolution& evolution, const algebra::Vector& X,
                           const complementarity::ActiveSet& active) {
  if (!fields_ || step <= last_frame_) return;
  const core::Region region("output");
  std::vector<output::FieldData> fields;
  if (const auto names = params_.output.model_names(); params_.output.fields == "all" || !names.empty())
    fields = evolution.fields(X, active, names);
  const output::Grid grid = evolution.grid();
  if (estimated_) add_estimates(params_.output, evolution.cell_estimates(), grid, fields);
  fields_->write(grid, fields, time);
  last_frame_ = step;
}

void FollowEvolution::finish(const models::Evolution& evolution, const EvolutionOutcome& outcome) {
  // what was stopped goes on with the frames that it would have had
  if (outcome.stopped.empty()) {
    estimated_ = estimated_ && outcome.solved;  // what was seen last is an attempt that has failed
    show(outcome.at.step, outcome.at.time, evolution, *outcome.X, outcome.active);
  }
  if (fields_) fields_->close();
}

void FollowEvolution::save(const TimePosition& at, double next_length, const models::Evolution& evolution, const algebra::Vector& X) const {
  const core::Region region("output");
  Written so_far = written();
  if (series_) so_far.series_rows = series_->rows();
  if (fields_) so_far.frames = fields_->frames();
  so_far.last_frame = last_frame_;
  checkpoint_.write(evolution, X, 0, stored_by(at, next_length, so_far));
}

std::string FollowEvolution::stop(const TimePosition& at, double next_length, const models::Evolution& evolution,
                                  const algebra::Vector& X) {
  const int signal = Interrupt::asked(evolution.comm());
  const int every = params_.output.checkpoint_every;
  if (at.time >= params_.time->end) return "";  // the run is done, and writes its last checkpoint itself
  const bool due = every > 0 && at.step % every == 0 && at.step != saved_step_;
  if (signal != 0 || due) save(at, next_length, evolution, X);
  if (due) saved_step_ = at.step;
  return signal == 0 ? "" : fmt::format("told to end by {}", Interrupt::name(signal));
}

void FollowEvolution::retry(const TimePosition& at, double length, const std::string& why, double next) const {
  log::warn("step {} from time {:.6g}: length {:.4g} is given up ({}); the next attempt has at most {:.4g}", at.step + 1, at.time, length,
            why, next);
}

output::HistoryRow FollowEvolution::row_within(const TimePosition& at, double end, int newton, int linear, double residual,
                                               const std::optional<complementarity::Estimate>& eta, std::optional<double> error) const {
  output::HistoryRow within = row(eta, error);
  within.time_step = at.step + 1;
  within.time = end;
  within.newton = newton;
  within.linear = linear;
  within.residual = residual;
  return within;
}

void FollowEvolution::newton(const TimePosition& at, double end, const complementarity::NewtonRecord& record, std::optional<double> error) {
  log::detail("{:>10} {:>3}{:>38}{:>10}{:>13.4e}{}", "Newton", record.step, record.linear_iterations, record.active, record.residual,
              estimate_columns(record.estimate));
  output::HistoryRow within = row_within(at, end, record.step, record.linear_iterations, record.residual, record.estimate, error);
  within.active = record.active;
  within.changed = record.changed;
  history_.append(within);
}

void FollowEvolution::check(const TimePosition& at, double end, const complementarity::LinearRecord& record, std::optional<double> error) {
  history_.append(row_within(at, end, record.step, record.iteration, record.residual, record.estimate, error));
}

}  // namespace thixis::drive
