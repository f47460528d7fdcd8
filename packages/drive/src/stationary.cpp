#include "thixis/drive/stationary.hpp"

#include "checkpoint.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {
namespace {

/// Hands on what Newton tells about a level, and counts in `at`.
complementarity::NewtonObserver on_level(Position& at, const models::Discretization& discretization, const Observer& observer) {
  complementarity::NewtonObserver newton;
  const int before = at.newton_on_level;
  newton.message = observer.message;
  newton.step = [before, &at, &observer](complementarity::NewtonRecord record) {
    record.step += before;
    at.newton_on_level = record.step;
    ++at.newton_iterations;
    at.linear_iterations += record.linear_iterations;
    if (observer.step)
      observer.step({at.level, record.step, record.linear_iterations, record.active, record.changed, record.residual, std::nullopt},
                    record);
  };
  if (observer.iterate)
    newton.iterate = [&at, &discretization, &observer](const algebra::Vector& X) { observer.iterate(at, discretization, X); };
  if (observer.check)
    newton.linear = [before, &at, &observer](const complementarity::LinearRecord& record) {
      observer.check({at.level, before + record.step, record.iteration, std::nullopt, std::nullopt, record.residual, std::nullopt});
    };
  return newton;
}

}  // namespace

Outcome solve_stationary(const models::Model& model, const mesh::Hierarchy& hierarchy, const RunParams& params, const Observer& observer,
                         const output::StoredCheckpoint* stored) {
  Outcome outcome;
  Position& at = outcome.at;
  if (stored) at = position_of(*stored);
  outcome.not_wanted = params.newton.max_iterations == 0;
  const int finest = static_cast<int>(hierarchy.levels.size()) - 1;
  const bool nested = params.newton.start == complementarity::Start::nested;
  const bool restart = stored && !outcome.not_wanted;
  const int first = restart ? at.level : nested && !outcome.not_wanted ? 0 : finest;

  complementarity::NewtonParams newton = params.newton;
  if (!newton.sweeps) newton.sweeps = nested && params.method.symmetric() ? 10 : 0;

  for (int level = first; level <= finest; ++level) {
    auto discretization = model.discretize(hierarchy, level);
    const auto X = outcome.discretization ? discretization->nested_start(*outcome.discretization, *outcome.X)
                   : restart              ? discretization->restore(*stored)
                                          : discretization->cold_start();
    if (at.level != level) at.newton_on_level = 0;
    at.level = level;
    outcome.discretization = std::move(discretization);
    outcome.X = X;
    outcome.mesh = &hierarchy.levels[level];
    if (observer.level) observer.level(hierarchy.levels[level], level, outcome.discretization->sizes());
    if (outcome.not_wanted) return outcome;

    const int linear_before = at.linear_iterations;
    outcome.finest = complementarity::newton(outcome.discretization->problem(), *X, newton, params.stopping, params.linear.check_every,
                                             on_level(at, *outcome.discretization, observer));
    at.linear_iterations = linear_before + outcome.finest.linear_iterations;  // those of a step that failed, too
    outcome.solved = outcome.finest.converged;
    if (!outcome.solved) break;
  }

  const core::Region region("verification");
  const auto kkt_data = outcome.discretization->kkt_data(*outcome.X);
  const double residual =
      params.stopping.nonlinear_tolerance * outcome.discretization->problem().reference_norm() + params.stopping.absolute_tolerance;
  outcome.kkt = complementarity::verify(kkt_data);
  outcome.kkt_tolerance = params.stopping.kkt_tolerance.value_or(kkt_data.allowed(residual));
  outcome.energy_error = outcome.discretization->energy_error(*outcome.X);
  outcome.energy_norm = outcome.discretization->energy_norm(*outcome.X);
  return outcome;
}

}  // namespace thixis::drive
