#pragma once
#include "follow/results.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::drive {

/// drive::run for stationary scenes.
core::ExitCode run_stationary(const RunParams& params, const models::StationaryModel& model, const core::Deck& deck, const core::Comm& comm,
                              const Versions& versions, const output::StoredCheckpoint* stored);

}  // namespace thixis::drive
