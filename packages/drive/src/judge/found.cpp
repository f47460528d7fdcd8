#include "checks/wanted.hpp"
#include "judge/expectations.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::drive {

namespace {

/// What is found alike at rest and in time.
template <class Ended>
Found begun(const models::SceneOnMesh& scene, const Ended& outcome) {
  Found found;
  found.solved = !outcome.not_wanted;
  found.sizes = scene.sizes();
  found.cells = scene.cells();
  found.doubts = scene.doubts();
  found.kkt = outcome.kkt;
  found.newton_iterations = outcome.at.newton_iterations;
  found.linear_iterations = outcome.at.linear_iterations;
  return found;
}

}  // namespace

Found found(const Outcome& outcome) {
  Found found = begun(*outcome.discretization, outcome);
  found.energy_error = outcome.energy_error;
  if (found.solved) found.energy_norm = outcome.energy_norm;
  found.estimate = outcome.estimate;
  found.published = outcome.published;
  found.contact = outcome.contact;
  found.at = outcome.at_points;
  found.newton_finest = outcome.at.newton_on_level;
  found.active = outcome.finest.active;
  found.of_model = outcome.of_model;
  found.summary = outcome.summary;
  return found;
}

Found found(const RunParams& params, const models::Model& model, const models::Evolution& evolution, const EvolutionOutcome& outcome) {
  Found found = begun(evolution, outcome);
  if (!found.solved) return found;
  found.energy_error = evolution.error_so_far();
  found.estimate = evolution.estimate_so_far();
  found.contact = evolution.contact(*outcome.X);
  if (!params.expect.at.empty())
    found.at = values_by_name(params.expect, model.point_fields(), evolution.values_at(wanted(params).expected, *outcome.X));
  found.newton_finest = outcome.last.steps;
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
