#pragma once
#include "follow/results.hpp"
#include "thixis/models/evolution.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::drive {

/// drive::run for scenes in time.
core::ExitCode run_unsteady(const RunParams& params, const models::UnsteadyModel& model, const core::Deck& deck, const core::Comm& comm,
                            const Versions& versions, const output::StoredCheckpoint* stored);

}  // namespace thixis::drive
