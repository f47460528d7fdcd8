#include "thixis/drive/stationary.hpp"

#include "checks/wanted.hpp"
#include "levels/adaptive.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {
namespace {

/// What is known about the solution beside the solver's own words.
void verify(Outcome& outcome, const RunParams& params, const models::Model& model) {
  models::Discretization& discretization = *outcome.discretization;
  if (outcome.estimate) outcome.cell_estimates = discretization.cell_estimates();
  if (outcome.estimate && params.stopping.estimate.value_or(false)) {
    const core::Region region("estimate");
    outcome.published = discretization.published_estimate(*outcome.X, params.stopping.friedrichs);
  }
  const core::Region region("verification");
  const auto kkt_data = discretization.kkt_data(*outcome.X);
  outcome.kkt = complementarity::verify(kkt_data);
  outcome.kkt_tolerance = kkt_tolerance(discretization, params.stopping, kkt_data, *outcome.X);
  if (!params.estimated()) outcome.energy_error = discretization.energy_error(*outcome.X);
  outcome.energy_norm = discretization.energy_norm(*outcome.X);
  outcome.rounding = discretization.rounding(*outcome.X);
  outcome.contact = discretization.contact(*outcome.X);
  if (!params.expect.at.empty())
    outcome.at_points = values_by_name(params.expect, model.point_fields(), discretization.values_at(wanted(params).expected, *outcome.X));
  outcome.of_model = discretization.expectations(params.expect, *outcome.X);
  outcome.summary = discretization.summary(*outcome.X);
}

}  // namespace

std::optional<double> Outcome::effectivity() const {
  if (!estimate || !energy_error) return std::nullopt;
  return estimate->total / *energy_error;
}

Outcome solve_stationary(const models::StationaryModel& model, mesh::Hierarchy& hierarchy, const RunParams& params,
                         const Observer& observer, const output::StoredCheckpoint* stored) {
  LevelSolver solver(model, hierarchy, params, observer, stored);
  const int finest = static_cast<int>(hierarchy.levels.size()) - 1;
  for (int level = solver.first(); level <= finest && solver.goes_on(); ++level) {
    auto discretization = solver.discretize(level);
    if (level > solver.first() && !allowed(*discretization, params)) {
      solver.outcome().refinement_ended = too_many_unknowns(params);
      solver.outcome().to_try = more_unknowns;
      solver.return_to_best();
      break;
    }
    require_allowed(*discretization, params);
    solver.solve(level, std::move(discretization));
  }
  if (params.adaptive() && solver.outcome().refinement_ended.empty()) solve_adaptively(solver, hierarchy, params, observer);

  Outcome outcome = std::move(solver.outcome());
  if (!outcome.not_wanted) verify(outcome, params, model);
  return outcome;
}

}  // namespace thixis::drive
