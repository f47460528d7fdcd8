#pragma once
#include "restart/checkpoint.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/output/history.hpp"

namespace thixis::drive {

/// The log's table of Newton steps, the history and the checkpoint follow the solve.
class Follow {
 public:
  /// `seconds_before`: spent before a restart.
  Follow(output::History& history, CheckpointFile& checkpoint, const RunParams& params, double seconds_before)
      : history_(history), checkpoint_(checkpoint), params_(params), seconds_before_(seconds_before) {}

  Observer observer();
  /// Whether the iterate was worth it.
  bool save(const Position& at, const models::Discretization& discretization, const algebra::Vector& X) const;

 private:
  double seconds() const { return seconds_before_ + clock_.seconds(); }
  void begin_level(const mesh::Mesh& mesh, int level, const models::Sizes& sizes) const;
  void end_level(const Progress& at);
  void step(const Progress& at, const complementarity::NewtonRecord& record);
  void refined(int level, const std::vector<GlobalIndex>& marked);
  output::HistoryRow row(const Progress& at) const;

  output::History& history_;
  CheckpointFile& checkpoint_;
  const RunParams& params_;
  double seconds_before_;
  core::Stopwatch clock_;
};

}  // namespace thixis::drive
