#include "follow/follower.hpp"

#include "follow/results.hpp"

namespace thixis::drive {

Follower::Follower(const output::RunDirectory& directory, const RunParams& params, const core::Comm& comm, CheckpointFile& checkpoint,
                   const Written& before)
    : params_(params),
      checkpoint_(checkpoint),
      before_(before),
      history_(output::History::go_on(directory.history(), before.history_rows, comm, params.output.history)) {}

bool Follower::sees_linear_iterates() const {
  return params_.stopping.rule != complementarity::StoppingRule::exact || params_.stopping.estimate.value_or(false);
}

output::HistoryRow Follower::row(const std::optional<complementarity::Estimate>& eta, std::optional<double> error) const {
  output::HistoryRow row;
  set_estimate(row, eta);
  row.energy_error = error;
  row.seconds = seconds();
  return row;
}

Written Follower::written() const {
  Written written = before_;
  written.history_rows = history_.rows();
  written.seconds = seconds();
  return written;
}

}  // namespace thixis::drive
