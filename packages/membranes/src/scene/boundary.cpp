#include "scene/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "thixis/core/error.hpp"
#include "thixis/mesh/groups.hpp"

namespace thixis::membranes {

bool steady(const std::vector<scene::FieldPtr>& fields) {
  return std::all_of(fields.begin(), fields.end(), [](const scene::FieldPtr& field) { return !field || field->steady(); });
}

bool steady_boundary(const MembraneScene& scene) {
  const auto is_steady = [](const BoundaryCondition& condition) {
    return condition.kind == BoundaryKind::neumann || steady({condition.value[0], condition.value[1]});
  };
  return is_steady(scene.default_boundary) &&
         std::all_of(scene.boundary.begin(), scene.boundary.end(), [&](const auto& part) { return is_steady(part.second); });
}

Boundary boundary_of(const MembraneScene& scene, const mesh::Mesh& mesh) {
  std::vector<std::string> names;
  for (const auto& [name, condition] : scene.boundary) names.push_back(name);
  Boundary boundary;
  boundary.named = mesh::named_groups(mesh.tags, names, "scene/boundary");
  for (std::size_t tag = 0; tag < mesh.tags.size(); ++tag) {
    const auto given = scene.boundary.find(boundary.named[tag]);
    const auto& condition = given == scene.boundary.end() ? scene.default_boundary : given->second;
    const bool dirichlet = condition.kind == BoundaryKind::dirichlet;
    const bool known = condition.value[0] && (scene.count == 1 || condition.value[1]);
    if (dirichlet && !known)
      throw core::InputError(fmt::format(
          "scene/boundary/{0}: nothing is said about this part of the boundary; give {1} there, or {1} in scene/data for all of it.",
          boundary.named[tag].empty() ? mesh.tags[tag] : boundary.named[tag], scene.count == 1 ? "g" : "g1 and g2"));
    boundary.dirichlet.push_back(dirichlet);
    for (int alpha = 0; alpha < scene.count; ++alpha) {
      boundary.values[alpha].dirichlet.push_back(dirichlet ? condition.value[alpha] : nullptr);
      boundary.values[alpha].neumann.push_back(dirichlet ? nullptr : condition.value[alpha]);
    }
  }
  return boundary;
}

}  // namespace thixis::membranes
