#pragma once
#include "follow/follower.hpp"
#include "thixis/core/log.hpp"
#include "thixis/output/fields.hpp"
#include "thixis/output/series.hpp"

namespace thixis::drive {

/// The log's table of time steps, history, series, fields and checkpoints follow a run in time.
class FollowEvolution : public Follower {
 public:
  /// `before`: what an interrupted run has left in this directory, of which the rows and frames up to its checkpoint stay; zeros: a new
  /// one. Collective.
  FollowEvolution(const output::RunDirectory& directory, const RunParams& params, const models::Evolution& evolution,
                  CheckpointFile& checkpoint, const Written& before, double first_time);

  EvolutionObserver observer();
  /// Fields of the last state, unless they are there already; closes the series of fields.
  void finish(const models::Evolution& evolution, const EvolutionOutcome& outcome);
  void save(const TimePosition& at, double next_length, const models::Evolution& evolution, const algebra::Vector& X) const;

 private:
  void begin_table() const;
  void step(const StepRecord& record, const models::Evolution& evolution, const algebra::Vector& X,
            const complementarity::ActiveSet& active);
  /// A row of the history within a step that ends at `end`.
  output::HistoryRow row_within(const TimePosition& at, double end, int newton, int linear, double residual,
                                const std::optional<complementarity::Estimate>& eta, std::optional<double> error) const;
  void newton(const TimePosition& at, double end, const complementarity::NewtonRecord& record, std::optional<double> error);
  void check(const TimePosition& at, double end, const complementarity::LinearRecord& record, std::optional<double> error);
  void retry(const TimePosition& at, double length, const std::string& why, double next) const;
  std::string stop(const TimePosition& at, double next_length, const models::Evolution& evolution, const algebra::Vector& X);
  void show(int step, double time, const models::Evolution& evolution, const algebra::Vector& X, const complementarity::ActiveSet& active);

  std::optional<output::Series> series_;       ///< where the scene has one
  std::optional<output::FieldWriter> fields_;  ///< where fields are asked for
  int last_frame_;                             ///< the step of the last frame; -1: none
  int saved_step_ = 0;                         ///< of the last checkpoint that was due
  bool estimated_ = false;                     ///< the last step
  double first_time_;
  core::log::Progress progress_;
};

}  // namespace thixis::drive
