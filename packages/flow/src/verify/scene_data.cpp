#include "verify/scene_data.hpp"

#include "thixis/mesh/groups.hpp"

namespace thixis::flow {
namespace {

/// Values of functions of the scene at places (x, y) of one kind; zero where there is no function.
std::vector<double> at(const scene::FieldPtr& field, const std::vector<std::array<double, 2>>& places, double t) {
  std::vector<double> x, y, values(places.size(), 0);
  for (const auto& place : places) {
    x.push_back(place[0]);
    y.push_back(place[1]);
  }
  if (field && !places.empty()) field->evaluate({places.size(), x.data(), y.data()}, t, values.data());
  return values;
}

}  // namespace

BoundaryData SceneData::boundary(double begin, double end) const {
  BoundaryData found;
  found.of_face.assign(grid.faces, -1);
  for (const auto& [tag, part] : scene.boundary) {
    if (part.kind == FlowBoundaryKind::no_flow) continue;
    std::vector<std::array<double, 2>> places;
    const int first = static_cast<int>(found.kind.size());
    std::vector<bool> belongs;  // by number of the tag
    for (const std::string& name : grid.tags) belongs.push_back(mesh::is_in_group(name, tag));
    for (LocalIndex F = 0; F < grid.faces; ++F) {
      if (on_host.face_tag(F) < 0 || !belongs[on_host.face_tag(F)]) continue;
      found.of_face[F] = first + static_cast<int>(places.size());
      places.push_back({on_host.face_centre(F, 0), on_host.face_centre(F, 1)});
    }
    const bool held = part.kind == FlowBoundaryKind::state;
    const auto s_g = at(held ? part.state.s_g : nullptr, places, end), P = at(held ? part.state.P : nullptr, places, end),
               chi = at(held ? part.state.chi : nullptr, places, end);
    const double middle = (begin + end) / 2;
    const auto w = at(held ? nullptr : part.water, places, middle), h = at(held ? nullptr : part.hydrogen, places, middle);
    for (std::size_t i = 0; i < places.size(); ++i) {
      found.kind.push_back(part.kind);
      found.outside.push_back({s_g[i], P[i], chi[i]});
      found.entering.push_back({w[i] / seconds_per_unit, h[i] / seconds_per_unit});
    }
  }
  return found;
}

std::array<std::vector<double>, 2> SceneData::sources(double middle) const {
  std::array<std::vector<double>, 2> made = {std::vector<double>(grid.owned_cells, 0), std::vector<double>(grid.owned_cells, 0)};
  if (!scene.water_source && !scene.hydrogen_source) return made;
  std::vector<std::array<double, 2>> places;
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) places.push_back({on_host.centre(K, 0), on_host.centre(K, 1)});
  made = {at(scene.water_source, places, middle), at(scene.hydrogen_source, places, middle)};
  for (auto& of : made)
    for (double& rate : of) rate /= seconds_per_unit;
  return made;
}

}  // namespace thixis::flow
