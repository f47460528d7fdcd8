#include <algorithm>

#include "step/step_evaluation.hpp"
#include "thixis/bound/published_bound.hpp"
#include "thixis/core/error.hpp"

namespace thixis::bound {
namespace {

bool steady(const std::vector<scene::FieldPtr>& fields) {
  return std::all_of(fields.begin(), fields.end(), [](const auto& field) { return !field || field->steady(); });
}

double friedrichs_of(const BoundParts& parts, std::optional<double> given) {
  const auto is_held = [](bool held) { return held; };
  if (given && std::none_of(parts.held.begin(), parts.held.end(), is_held))
    throw core::InputError("stopping/friedrichs constant: there is none where nothing is held; leave it out.");
  if (given) return *given;
  return std::all_of(parts.held.begin(), parts.held.end(), is_held) ? friedrichs_of_box(parts.space.mesh()) : 0;
}

double least_of_all(const core::Comm& comm, const std::vector<double>& of_cells) {
  double least = 1e300;
  for (const double mu : of_cells) least = std::min(least, mu);
  return comm.min(least);
}

}  // namespace

StepSetting::StepSetting(const BoundParts& parts, std::optional<double> given) {
  if (!parts.discretization.on_patches() && parts.q == parts.space.basis().degree())
    throw core::InputError("scene/model: there is no bound in time for this method; write fem or hho under method/name.");
  friedrichs = friedrichs_of(parts, given);
  const ContactProblem& problem = parts.problem;
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    steady_force = steady_force && problem.force[alpha]->steady();
    steady_boundary = steady_boundary && steady(problem.boundary[alpha].dirichlet);
    if (!problem.tension[alpha]->steady() || !steady(problem.boundary[alpha].neumann))
      throw core::InputError("scene/data: the bound in time needs tensions and tractions that do not depend on t.");
    least[alpha] = least_of_all(parts.comm(), parts.membrane[alpha].least_tension);
  }
}

}  // namespace thixis::bound
