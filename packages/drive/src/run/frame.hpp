#pragma once
#include "follow/results.hpp"
#include "restart/checkpoint.hpp"
#include "restart/stored.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {

/// What runs at rest and in time do alike, before they solve and after.
class Frame {
 public:
  /// Touches nothing. `stored`: the checkpoint that the run goes on from, or null.
  Frame(const RunParams& params, const models::Model& model, const core::Deck& deck, const core::Comm& comm, const Versions& versions,
        const output::StoredCheckpoint* stored);

  const output::RunDirectory& directory() const { return directory_; }
  CheckpointFile& checkpoint() { return checkpoint_; }
  /// Whether the run goes on in the directory of the interrupted one, behind its rows and frames.
  bool goes_on() const { return goes_on_; }
  /// What counts here of that which the interrupted run has written.
  Written before(const Written& by_interrupted) const;

  /// Makes the directory and begins the log; `from`: where the restart goes on from, a sentence. Removes the checkpoint of an older run.
  void begin(const std::string& from);
  /// Writes the summary and ends the log.
  core::ExitCode end(const Found& found, const Verdict& verdict, const std::string& invitation) const;

 private:
  const RunParams& params_;
  const models::Model& model_;
  const core::Deck& deck_;
  const core::Comm& comm_;
  const Versions& versions_;
  const output::StoredCheckpoint* stored_;
  core::Stopwatch clock_;
  output::RunDirectory directory_;
  CheckpointFile checkpoint_;
  bool goes_on_;
};

}  // namespace thixis::drive
