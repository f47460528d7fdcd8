#include "thixis/drive/run.hpp"

#include "run_stationary.hpp"
#include "run_unsteady.hpp"
#include "thixis/core/timer.hpp"
#include "unchanged.hpp"

namespace thixis::drive {

core::ExitCode run(const RunParams& params, const models::Model& model, const core::Deck& deck, const core::Comm& comm,
                   const Versions& versions, const output::StoredCheckpoint* stored) {
  core::reset_regions();
  if (stored) check_unchanged(*stored, params);
  if (const auto* unsteady = dynamic_cast<const models::UnsteadyModel*>(&model))
    return run_unsteady(params, *unsteady, deck, comm, versions, stored);
  return run_stationary(params, dynamic_cast<const models::StationaryModel&>(model), deck, comm, versions, stored);
}

}  // namespace thixis::drive
