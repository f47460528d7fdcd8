#include "thixis/drive/run.hpp"

#include "checks/sizes.hpp"
#include "restart/unchanged.hpp"
#include "run/run_stationary.hpp"
#include "run/run_unsteady.hpp"
#include "steps/step_control.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {

void check_ahead(const RunParams& params, const models::Model& model) {
  if (const auto* unsteady = dynamic_cast<const models::UnsteadyModel*>(&model))
    unsteady->check(params.mesh, known_times(*params.time, {}, 0));
}

core::ExitCode run(const RunParams& params, const models::Model& model, const core::Deck& deck, const core::Comm& comm,
                   const Versions& versions, const output::StoredCheckpoint* stored) {
  core::reset_regions();
  if (stored) check_unchanged(*stored, params);
  require_memory(params, comm);
  if (const auto* unsteady = dynamic_cast<const models::UnsteadyModel*>(&model))
    return run_unsteady(params, *unsteady, deck, comm, versions, stored);
  return run_stationary(params, dynamic_cast<const models::StationaryModel&>(model), deck, comm, versions, stored);
}

}  // namespace thixis::drive
