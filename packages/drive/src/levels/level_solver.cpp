#include "levels/level_solver.hpp"

#include "restart/stored.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {

LevelSolver::LevelSolver(const models::StationaryModel& model, const mesh::Hierarchy& hierarchy, const RunParams& params,
                         const Observer& observer, const output::StoredCheckpoint* stored)
    : model_(model), hierarchy_(hierarchy), params_(params), observer_(observer), stored_(stored), look_(params.output) {
  if (stored) outcome_.at = stored_iterate(*stored).at;
  outcome_.not_wanted = params.newton.max_iterations == 0;
  if (outcome_.not_wanted) stored_ = nullptr;
}

int LevelSolver::first() const {
  if (stored_) return outcome_.at.level;
  const bool nested = params_.newton.start == complementarity::Start::nested;
  return nested && !outcome_.not_wanted ? 0 : static_cast<int>(hierarchy_.levels.size()) - 1;
}

void LevelSolver::solve(int level, std::unique_ptr<models::Discretization> discretization) {
  enter(level, std::move(discretization));
  if (outcome_.not_wanted) return;
  run_newton();
  if (params_.estimated()) estimate();
}

void LevelSolver::enter(int level, std::unique_ptr<models::Discretization> discretization) {
  const auto X = outcome_.discretization ? discretization->nested_start(*outcome_.discretization, *outcome_.X)
                 : stored_               ? discretization->restore(*stored_)
                                         : discretization->cold_start();
  if (outcome_.at.level != level) outcome_.at.newton_on_level = 0;
  outcome_.nested = outcome_.discretization || (stored_ && level > params_.mesh.refinements);
  outcome_.discretization = std::move(discretization);
  outcome_.X = X;
  set_mesh(level);
  if (observer_.level) observer_.level(*outcome_.mesh, level, outcome_.discretization->sizes());
}

void LevelSolver::set_mesh(int level) {
  outcome_.at.level = level;
  outcome_.mesh = &hierarchy_.levels[level];
}

void LevelSolver::run_newton() {
  complementarity::NewtonParams newton = params_.newton;
  const bool nested = newton.start == complementarity::Start::nested || outcome_.nested;
  models::Discretization& discretization = *outcome_.discretization;
  if (!newton.sweeps) newton.sweeps = nested ? discretization.sweeps() : 0;
  const int linear_before = outcome_.at.linear_iterations;
  outcome_.finest = complementarity::newton(discretization.problem(), *outcome_.X, newton, params_.stopping, params_.linear.check_every,
                                            on_level(), [this](const algebra::Vector& X) { return look_(*outcome_.discretization, X); });
  outcome_.at.linear_iterations = linear_before + outcome_.finest.linear_iterations;  // those of a step that failed, too
  outcome_.solved = outcome_.finest.converged;
}

/// Once at the end of a level, unless Newton has done it.
void LevelSolver::estimate() {
  outcome_.estimate = estimate_at_end(*outcome_.discretization, outcome_.finest, *outcome_.X);
  {
    const core::Region region("verification");
    outcome_.energy_error = outcome_.discretization->energy_error(*outcome_.X);
  }
  if (params_.stopping.target && outcome_.solved && !(best_ && best_->bound <= outcome_.estimate->total))
    best_ = {outcome_.at.level, outcome_.at.newton_on_level, outcome_.X, outcome_.finest, outcome_.estimate->total};
  if (!observer_.level_end) return;
  Progress progress;
  progress.level = outcome_.at.level;
  progress.energy_error = outcome_.energy_error;
  progress.estimate = outcome_.estimate;
  observer_.level_end(progress);
}

void LevelSolver::return_to_best() {
  if (!best_ || best_->level == outcome_.at.level) return;
  set_mesh(best_->level);
  outcome_.at.newton_on_level = best_->newton_on_level;
  outcome_.finest = best_->newton;
  outcome_.discretization = discretize(best_->level);
  outcome_.X = Teuchos::rcp(new algebra::Vector(outcome_.discretization->problem().map()));
  Tpetra::deep_copy(*outcome_.X, *best_->X);
  const core::Region region("estimate");
  outcome_.estimate = outcome_.discretization->estimate(*outcome_.X);
  outcome_.energy_error = outcome_.discretization->energy_error(*outcome_.X);
}

/// Hands on what Newton tells about a level, and counts in `at`.
complementarity::NewtonObserver LevelSolver::on_level() {
  complementarity::NewtonObserver newton;
  Position& at = outcome_.at;
  const int before = at.newton_on_level;
  newton.message = observer_.message;
  newton.step = [before, &at, this](complementarity::NewtonRecord record) {
    record.step += before;
    at.newton_on_level = record.step;
    ++at.newton_iterations;
    at.linear_iterations += record.linear_iterations;
    if (observer_.step)
      observer_.step({at.level, record.step, record.linear_iterations, record.active, record.changed, record.residual,
                      look_.error(record.estimate), record.estimate},
                     record);
  };
  if (observer_.iterate) newton.iterate = [&at, this](const algebra::Vector& X) { observer_.iterate(at, *outcome_.discretization, X); };
  if (observer_.check)
    newton.linear = [before, &at, this](const complementarity::LinearRecord& record) {
      observer_.check({at.level, before + record.step, record.iteration, std::nullopt, std::nullopt, record.residual,
                       look_.error(record.estimate), record.estimate});
    };
  return newton;
}

}  // namespace thixis::drive
