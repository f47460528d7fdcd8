#pragma once
#include "restart/checkpoint.hpp"
#include "restart/stored.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/output/directory.hpp"
#include "thixis/output/history.hpp"

namespace thixis::drive {

/// History, checkpoint and wall clock of a run, at rest or in time.
class Follower {
 public:
  /// `before`: what an interrupted run has left in this directory, of which the rows up to its checkpoint stay; zeros: a new one.
  /// Collective.
  Follower(const output::RunDirectory& directory, const RunParams& params, const core::Comm& comm, CheckpointFile& checkpoint,
           const Written& before);

 protected:
  double seconds() const { return before_.seconds + clock_.seconds(); }
  /// Under the exact rule nobody looks at linear iterates, and none is formed, unless the user wants to see the estimate there.
  bool sees_linear_iterates() const;
  /// A row of the history, to be filled in.
  output::HistoryRow row(const std::optional<complementarity::Estimate>& eta, std::optional<double> error) const;
  /// So far.
  Written written() const;

  const RunParams& params_;
  CheckpointFile& checkpoint_;
  Written before_;
  output::History history_;

 private:
  core::Stopwatch clock_;
};

}  // namespace thixis::drive
