#include <algorithm>

#include "checks/wanted.hpp"
#include "judge/expectations.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::drive {

Found found(const Outcome& outcome) {
  Found found;
  found.solved = !outcome.not_wanted;
  found.sizes = outcome.discretization->sizes();
  found.cells = outcome.mesh->global_cells;
  found.energy_error = outcome.energy_error;
  if (found.solved) found.energy_norm = outcome.energy_norm;
  found.estimate = outcome.estimate;
  found.doubts = outcome.discretization->doubts();
  found.published = outcome.published;
  found.kkt = outcome.kkt;
  found.contact = outcome.contact;
  found.at = outcome.at_points;
  found.newton_iterations = outcome.at.newton_iterations;
  found.newton_finest = outcome.at.newton_on_level;
  found.linear_iterations = outcome.at.linear_iterations;
  found.active = outcome.finest.active;
  return found;
}

Found found(const RunParams& params, const models::Model& model, const models::Evolution& evolution, const EvolutionOutcome& outcome) {
  Found found;
  found.solved = !outcome.not_wanted;
  found.sizes = evolution.sizes();
  found.cells = evolution.cells();
  if (!found.solved) return found;
  found.energy_error = evolution.error_so_far();
  found.estimate = evolution.estimate_so_far();
  found.doubts = evolution.doubts();
  found.kkt = outcome.kkt;
  found.contact = evolution.contact(*outcome.X);
  if (!params.expect.at.empty())
    found.at = values_by_name(params.expect, model.point_fields(), evolution.values_at(wanted(params).expected, *outcome.X));
  found.newton_iterations = outcome.at.newton_iterations;
  found.newton_finest = outcome.last.steps;
  found.linear_iterations = outcome.at.linear_iterations;
  found.active = outcome.active.count();
  found.in_time = output::SummaryTime{outcome.at.step, outcome.at.retries, outcome.at.time};
  found.of_model = evolution.expectations(params.expect, *outcome.X);
  found.summary = evolution.summary(*outcome.X);
  return found;
}

std::optional<double> Found::effectivity() const {
  if (!energy_error || !estimate) return {};
  return estimate->total / *energy_error;
}

}  // namespace thixis::drive
