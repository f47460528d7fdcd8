#include "levels/adaptive.hpp"

#include <fmt/format.h>

#include "refine/marking.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/mesh/adapt.hpp"

namespace thixis::drive {
namespace {

void refine(mesh::Hierarchy& hierarchy, const std::vector<GlobalIndex>& marked) {
  const core::Region region("mesh");
  mesh::adapt(hierarchy, owned(hierarchy.finest(), marked));
}

}  // namespace

void solve_adaptively(LevelSolver& solver, mesh::Hierarchy& hierarchy, const RunParams& params, const Observer& observer) {
  const AdaptParams adapt = params.adapt.value_or(AdaptParams());
  Outcome& outcome = solver.outcome();
  const auto end = [&](const std::string& why, const std::string& to_try) {
    outcome.refinement_ended = why;
    outcome.to_try = to_try;
    solver.return_to_best();
  };

  for (int added = static_cast<int>(hierarchy.levels.size()) - 1 - params.mesh.refinements; solver.goes_on(); ++added) {
    if (params.stopping.target && outcome.estimate->total <= *params.stopping.target) return;
    if (added >= adapt.max_levels)
      return end(fmt::format("adapt/max levels = {}", adapt.max_levels),
                 "allow more of them, take a larger adapt/theta or a higher method/degree, or begin with a finer mesh");

    const auto wanted = mark(*outcome.mesh, adapt, outcome.discretization->cell_estimates().discretization);
    if (wanted.empty())
      return end("no cell with a discretization error",
                 "what is left comes from the solvers: lower stopping/linear tolerance and stopping/nonlinear tolerance");
    const auto marked = refinable(*outcome.mesh, wanted);
    if (marked.empty())
      return end("its smallest cells: no marked cell can be refined further",
                 "look at the field eta_disc: name the curves where data jump in scene/interface, or ask for less");
    refine(hierarchy, marked);

    const int level = outcome.at.level + 1;
    auto finer = solver.discretize(level);
    if (!allowed(*finer, params)) return end(too_many_unknowns(params), more_unknowns);
    if (observer.refined) observer.refined(level, marked);
    solver.solve(level, std::move(finer));
  }
}

bool allowed(const models::Discretization& discretization, const RunParams& params) {
  return !params.adaptive() || discretization.sizes().unknowns_all <= params.adapt.value_or(AdaptParams()).max_unknowns;
}

std::string too_many_unknowns(const RunParams& params) {
  return fmt::format("adapt/max unknowns = {}", params.adapt.value_or(AdaptParams()).max_unknowns);
}

void require_allowed(const models::Discretization& discretization, const RunParams& params) {
  if (allowed(discretization, params)) return;
  throw core::InputError(fmt::format(
      "adapt/max unknowns: the run begins on a mesh with {} unknowns, more than {}; write at least as many, or fewer mesh/refinements.",
      discretization.sizes().unknowns_all, params.adapt.value_or(AdaptParams()).max_unknowns));
}

}  // namespace thixis::drive
