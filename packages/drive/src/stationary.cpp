#include "thixis/drive/stationary.hpp"

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {
namespace {

complementarity::NewtonObserver on_level(int level, const Observer& observer) {
  complementarity::NewtonObserver newton;
  newton.message = observer.message;
  if (observer.step)
    newton.step = [level, &observer](const complementarity::NewtonRecord& record) {
      observer.step({level, record.step, record.linear_iterations, record.active, record.changed, record.residual, std::nullopt}, record);
    };
  if (observer.check)
    newton.linear = [level, &observer](const complementarity::LinearRecord& record) {
      observer.check({level, record.step, record.iteration, std::nullopt, std::nullopt, record.residual, std::nullopt});
    };
  return newton;
}

}  // namespace

Outcome solve_stationary(const models::Model& model, const mesh::Hierarchy& hierarchy, const RunParams& params, const Observer& observer) {
  Outcome outcome;
  outcome.not_wanted = params.newton.max_iterations == 0;
  const int finest = static_cast<int>(hierarchy.levels.size()) - 1;
  const bool nested = params.newton.start == complementarity::Start::nested && !outcome.not_wanted;

  complementarity::NewtonParams newton = params.newton;
  if (!newton.sweeps) newton.sweeps = nested ? 10 : 0;

  for (int level = nested ? 0 : finest; level <= finest; ++level) {
    auto discretization = model.discretize(hierarchy.levels[level]);
    const auto X =
        outcome.discretization ? discretization->nested_start(*outcome.discretization, *outcome.X) : discretization->cold_start();
    outcome.discretization = std::move(discretization);
    outcome.X = X;
    outcome.mesh = &hierarchy.levels[level];
    if (observer.level) observer.level(hierarchy.levels[level], level, outcome.discretization->sizes());
    if (outcome.not_wanted) return outcome;

    outcome.finest = complementarity::newton(outcome.discretization->problem(), *X, newton, params.stopping, params.linear.check_every,
                                             on_level(level, observer));
    outcome.newton_iterations += outcome.finest.steps;
    outcome.linear_iterations += outcome.finest.linear_iterations;
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
