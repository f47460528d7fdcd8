#include "step/scene_on_grid.hpp"

#include "thixis/mesh/groups.hpp"

namespace thixis::flow {

SceneOnGrid::SceneOnGrid(const fv::Grid& grid, const TwoPhaseScene& scene, const TwoPhaseLaws& laws, double seconds_per_unit)
    : comm_(grid.comm),
      scene_(scene),
      laws_(laws),
      seconds_per_unit_(seconds_per_unit),
      cells_(centres(grid)),
      face_kind_("thixis::flow::face_kind", grid.faces) {
  std::vector<std::string> names;
  for (const auto& [name, part] : scene.boundary) names.push_back(name);
  mesh::named_groups(grid.tags, names, "scene/flow/boundary");
  Kokkos::deep_copy(face_kind_, FlowBoundaryKind::no_flow);
  for (const auto& [name, part] : scene.boundary) {
    const Places& places = parts_[name] = part_of_boundary(grid, name);
    const auto to = face_kind_;
    const auto index = places.index;
    const FlowBoundaryKind kind = part.kind;
    Kokkos::parallel_for(
        "thixis::flow::face_kind", Kokkos::RangePolicy<>(0, places.count()), KOKKOS_LAMBDA(LocalIndex i) { to(index(i)) = kind; });
  }
}

StateValues SceneOnGrid::initial() const {
  return comm_.together([&] { return states_at(scene_.initial, laws_, cells_, 0, "initial"); });
}

void SceneOnGrid::check(double t) const {
  comm_.together([&] {
    for (const auto& [tag, part] : scene_.boundary)
      if (part.kind == FlowBoundaryKind::state) states_at(part.state, laws_, parts_.at(tag), t, "boundary/" + tag);
  });
}

void SceneOnGrid::set_data(double begin, double end, FlowStep& step) const {
  const double middle = 0.5 * (begin + end);
  comm_.together([&] {
    set_rates(scene_.water_source, cells_, middle, water, step.source);
    set_rates(scene_.hydrogen_source, cells_, middle, hydrogen, step.source);
    for (const auto& [tag, part] : scene_.boundary) {
      if (part.kind == FlowBoundaryKind::flux) {
        set_rates(part.water, parts_.at(tag), middle, water, step.inflow);
        set_rates(part.hydrogen, parts_.at(tag), middle, hydrogen, step.inflow);
      } else if (part.kind == FlowBoundaryKind::state) {
        set_states(tag, end, step.outside);
      }
    }
  });
}

/// Per second; where there is no function the rates are 0.
void SceneOnGrid::set_rates(const scene::FieldPtr& field, const Places& places, double t, Component c,
                            const fv::View<double* [components]>& rates) const {
  if (!field) return;
  const auto values = places.values(field, t);
  const auto index = places.index;
  const auto& to = rates;
  const double seconds = seconds_per_unit_;
  Kokkos::parallel_for(
      "thixis::flow::rates", Kokkos::RangePolicy<>(0, places.count()),
      KOKKOS_LAMBDA(LocalIndex i) { to(index(i), c) = values(i) / seconds; });
}

void SceneOnGrid::set_states(const std::string& tag, double t, const fv::View<PhaseState*>& outside) const {
  const Places& places = parts_.at(tag);
  const StateValues at = states_at(scene_.boundary.at(tag).state, laws_, places, t, "boundary/" + tag);
  const auto index = places.index;
  const auto& to = outside;
  const TwoPhaseLaws laws = laws_;
  Kokkos::parallel_for(
      "thixis::flow::outside", Kokkos::RangePolicy<>(0, places.count()),
      KOKKOS_LAMBDA(LocalIndex i) { to(index(i)) = laws.state(at.s_g(i), at.P(i), at.chi(i)); });
}

}  // namespace thixis::flow
