#pragma once
#include "look/look.hpp"
#include "thixis/drive/stationary.hpp"

namespace thixis::drive {

/// Solves one level after the other, each from the solution on the one before, and keeps the last one.
class LevelSolver {
 public:
  LevelSolver(const models::StationaryModel& model, const mesh::Hierarchy& hierarchy, const RunParams& params, const Observer& observer,
              const output::StoredCheckpoint* stored);

  /// The level to begin with: that of the checkpoint, the coarsest one of nested starts, else the finest one.
  int first() const;
  /// Nothing is in the way of the next level: the last one was solved, or there was none.
  bool goes_on() const { return !outcome_.discretization || (outcome_.solved && !outcome_.not_wanted); }
  std::unique_ptr<models::Discretization> discretize(int level) const { return model_.discretize(hierarchy_, level); }
  /// Newton on a level, from the last solution, the checkpoint or a cold start; then, where the error is estimated, the estimate at its
  /// end.
  void solve(int level, std::unique_ptr<models::Discretization> discretization);

  /// Where a finer mesh has not made the bound smaller: back to the solution with the smallest one. Only in runs with a target.
  void return_to_best();

  Outcome& outcome() { return outcome_; }

 private:
  void enter(int level, std::unique_ptr<models::Discretization> discretization);
  void run_newton();
  void set_mesh(int level);
  void estimate();
  complementarity::NewtonObserver on_level();

  const models::StationaryModel& model_;
  const mesh::Hierarchy& hierarchy_;
  const RunParams& params_;
  const Observer& observer_;
  const output::StoredCheckpoint* stored_;
  Outcome outcome_;
  Look look_;

  /// A solution without its discretization.
  struct Kept {
    int level, newton_on_level;
    Teuchos::RCP<algebra::Vector> X;
    complementarity::NewtonReport newton;
    double bound;
  };
  std::optional<Kept> best_;
};

}  // namespace thixis::drive
