#include "step/operator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"
#include "thixis/mesh/groups.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

constexpr double negligible = 1e-9;  // of the pressures of which that of the gas is the sum

algebra::MapPtr columns_of(const fv::Grid& grid) {
  std::vector<GlobalIndex> ids;
  ids.reserve(static_cast<std::size_t>(unknowns_per_cell) * grid.cells);
  for (LocalIndex K = 0; K < grid.cells; ++K)
    for (int u = 0; u < unknowns_per_cell; ++u) ids.push_back(unknowns_per_cell * grid.cell_id[K] + u);
  return algebra::map_of(ids, grid.comm);
}

/// Places where functions of the scene are asked for, in the order of their indices.
struct Places {
  std::vector<LocalIndex> index;
  std::vector<double> x, y;

  void add(LocalIndex i, double at_x, double at_y) {
    index.push_back(i);
    x.push_back(at_x);
    y.push_back(at_y);
  }
  std::vector<double> values(const scene::FieldPtr& field, double t) const {
    std::vector<double> out(index.size(), 0);
    if (field) field->evaluate({x.size(), x.data(), y.data()}, t, out.data());
    return out;
  }
};

Places centres(const fv::Grid& grid) {
  const auto centre = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), grid.centre);
  Places places;
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) places.add(K, centre(K, 0), centre(K, 1));
  return places;
}

/// Midpoints of the faces of the boundary that lie in a group.
Places part_of_boundary(const fv::Grid& grid, const std::string& name) {
  const auto tag = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), grid.face_tag);
  const auto centre = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), grid.face_centre);
  Places places;
  for (LocalIndex F = 0; F < grid.faces; ++F)
    if (tag(F) >= 0 && mesh::is_in_group(grid.tags[tag(F)], name)) places.add(F, centre(F, 0), centre(F, 1));
  return places;
}

/// The state of the scene at these places. Throws InputError for values that are no state, on this rank only.
std::vector<PhaseState> states_of(const FlowState& state, const TwoPhaseLaws& laws, const Places& places, double t,
                                  const std::string& path) {
  const auto s_g = places.values(state.s_g, t), P = places.values(state.P, t), chi = places.values(state.chi, t);
  std::vector<PhaseState> states;
  states.reserve(s_g.size());
  for (std::size_t i = 0; i < s_g.size(); ++i) {
    const auto refuse = [&](const std::string& what) {
      throw core::InputError(
          fmt::format("scene/flow/{}: at ({}, {}) {}", path, core::to_text(places.x[i]), core::to_text(places.y[i]), what));
    };
    if (!(s_g[i] >= 0 && laws.e_of(s_g[i]) < TwoPhaseLaws::dry))
      refuse(fmt::format("the gas saturation is {}; it must not be negative, and leave more liquid than S_lr.", core::to_text(s_g[i])));
    if (!(chi[i] >= 0 && chi[i] <= 1)) refuse(fmt::format("chi is {}; a molar fraction lies between 0 and 1.", core::to_text(chi[i])));
    states.push_back(laws.state(s_g[i], P[i], chi[i]));
    const double P_g = states.back().P_g.value;
    if (!(P_g >= -negligible * std::max(std::abs(P[i]), std::abs(P_g - P[i]))))
      refuse(fmt::format(
          "P is {}, and the pressure of the gas, P + P_cp(s_g) = {}, is negative; write a larger P (in Pa, counted from vacuum).",
          core::to_text(P[i]), core::to_text(P_g)));
  }
  return states;
}

struct StatesOf {
  TwoPhaseLaws laws;
  decltype(std::declval<const Vector&>().getLocalViewDevice(Tpetra::Access::ReadOnly)) X;
  fv::View<PhaseState*> states;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const LocalIndex k = unknowns_per_cell * K;
    states(K) = laws.state(X(k, 0), X(k + 1, 0), X(k + 2, 0));
  }
};

struct MassesOf {
  TwoPhaseLaws laws;
  fv::View<PhaseState*> states;
  fv::View<double* [components]> masses;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const Masses l = laws.masses(states(K));
    for (int c = 0; c < components; ++c) masses(K, c) = l.value[c];
  }
};

struct FluxesOf {
  TwoPhaseLaws laws;
  fv::View<LocalIndex* [2]> face_cells;
  fv::View<double*> distance;
  fv::View<double* [2]> normal;
  fv::View<FlowBoundaryKind*> kind;
  fv::View<PhaseState*> states, outside;
  fv::View<double* [components]> inflow;
  fv::View<FaceFlux*> fluxes;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex F) const {
    const PhaseState& A = states(face_cells(F, 0));
    const double g_n = laws.gravity[0] * normal(F, 0) + laws.gravity[1] * normal(F, 1);
    if (face_cells(F, 1) >= 0) {
      fluxes(F) = laws.flux(A, states(face_cells(F, 1)), distance(F), g_n);
    } else if (kind(F) == FlowBoundaryKind::state) {
      fluxes(F) = laws.flux(A, outside(F), distance(F), g_n);
    } else {
      FaceFlux given{};
      if (kind(F) == FlowBoundaryKind::flux)
        for (int c = 0; c < components; ++c) given.value[c] = -inflow(F, c);
      fluxes(F) = given;
    }
  }
};

}  // namespace

TwoPhaseOperator::TwoPhaseOperator(fv::Grid grid, const TwoPhaseScene& scene, double seconds_per_unit)
    : grid_(std::move(grid)),
      scene_(scene),
      seconds_per_unit_(seconds_per_unit),
      laws_(two_phase_laws(scene)),
      cells_(algebra::map_of({grid_.cell_id.begin(), grid_.cell_id.begin() + grid_.owned_cells}, grid_.comm)),
      map_(algebra::interlaced(cells_, unknowns_per_cell)),
      column_map_(columns_of(grid_)),
      import_(Teuchos::rcp(new algebra::Import(map_, column_map_))),
      face_kind_("thixis::flow::face_kind", grid_.faces) {
  set_boundary(scene);
}

void TwoPhaseOperator::set_boundary(const TwoPhaseScene& scene) {
  const auto kind = Kokkos::create_mirror_view(face_kind_);
  Kokkos::deep_copy(kind, FlowBoundaryKind::no_flow);
  std::vector<std::string> names;
  for (const auto& [name, part] : scene.boundary) names.push_back(name);
  mesh::named_groups(grid_.tags, names, "scene/flow/boundary");
  for (const auto& [name, part] : scene.boundary)
    for (const LocalIndex F : part_of_boundary(grid_, name).index) kind(F) = part.kind;
  Kokkos::deep_copy(face_kind_, kind);
}

Teuchos::RCP<Vector> TwoPhaseOperator::initial() const {
  const auto states = grid_.comm.together([&] { return states_of(scene_.initial, laws_, centres(grid_), 0, "initial"); });
  const auto X = Teuchos::rcp(new Vector(map_));
  const auto x = algebra::host_overwrite(*X);
  for (LocalIndex K = 0; K < grid_.owned_cells; ++K) {
    x(unknowns_per_cell * K + gas_saturation) = states[K].s_g;
    x(unknowns_per_cell * K + pressure) = states[K].P;
    x(unknowns_per_cell * K + dissolved) = states[K].chi;
  }
  return X;
}

void TwoPhaseOperator::check(double t) const {
  grid_.comm.together([&] {
    for (const auto& [tag, part] : scene_.boundary)
      if (part.kind == FlowBoundaryKind::state) states_of(part.state, laws_, part_of_boundary(grid_, tag), t, "boundary/" + tag);
  });
}

FlowStep TwoPhaseOperator::step(double begin, double end, const Vector& before) const {
  FlowStep step;
  step.length = (end - begin) * seconds_per_unit_;
  step.before = fv::View<double* [components]>("thixis::flow::masses_before", grid_.owned_cells);
  step.owed = fv::View<double* [components]>("thixis::flow::owed", grid_.owned_cells);
  step.source = fv::View<double* [components]>("thixis::flow::source", grid_.owned_cells);
  step.inflow = fv::View<double* [components]>("thixis::flow::inflow", grid_.faces);
  step.outside = fv::View<PhaseState*>("thixis::flow::outside", grid_.faces);

  const double middle = 0.5 * (begin + end);
  const auto source = Kokkos::create_mirror_view(step.source), inflow = Kokkos::create_mirror_view(step.inflow);
  const auto outside = Kokkos::create_mirror_view(step.outside);
  const auto rates = [&](const scene::FieldPtr& field, const Places& places, Component c, const auto& out) {
    const auto values = places.values(field, middle);
    for (std::size_t i = 0; i < values.size(); ++i) out(places.index[i], c) = values[i] / seconds_per_unit_;
  };
  grid_.comm.together([&] {
    if (scene_.water_source || scene_.hydrogen_source) {
      const Places places = centres(grid_);
      rates(scene_.water_source, places, water, source);
      rates(scene_.hydrogen_source, places, hydrogen, source);
    }
    for (const auto& [tag, part] : scene_.boundary) {
      if (part.kind == FlowBoundaryKind::no_flow) continue;
      const Places places = part_of_boundary(grid_, tag);
      if (part.kind == FlowBoundaryKind::flux) {
        rates(part.water, places, water, inflow);
        rates(part.hydrogen, places, hydrogen, inflow);
      } else {
        const auto states = states_of(part.state, laws_, places, end, "boundary/" + tag);
        for (std::size_t i = 0; i < states.size(); ++i) outside(places.index[i]) = states[i];
      }
    }
  });
  Kokkos::deep_copy(step.source, source);
  Kokkos::deep_copy(step.inflow, inflow);
  Kokkos::deep_copy(step.outside, outside);

  step.states_before = states(before);
  Kokkos::parallel_for("thixis::flow::masses_before", Kokkos::RangePolicy<>(0, grid_.owned_cells),
                       MassesOf{laws_, step.states_before, step.before});
  return step;
}

Vector TwoPhaseOperator::with_ghosts(const Vector& X) const {
  Vector all(column_map_);
  all.doImport(X, *import_, Tpetra::INSERT);
  return all;
}

fv::View<PhaseState*> TwoPhaseOperator::states(const Vector& X) const {
  const Vector all = with_ghosts(X);
  const fv::View<PhaseState*> states("thixis::flow::states", grid_.cells);
  Kokkos::parallel_for("thixis::flow::states", Kokkos::RangePolicy<>(0, grid_.cells),
                       StatesOf{laws_, all.getLocalViewDevice(Tpetra::Access::ReadOnly), states});
  return states;
}

fv::View<FaceFlux*> TwoPhaseOperator::fluxes(const fv::View<PhaseState*>& states, const FlowStep& step) const {
  const fv::View<FaceFlux*> fluxes("thixis::flow::fluxes", grid_.faces);
  FluxesOf kernel{laws_};
  kernel.face_cells = grid_.face_cells;
  kernel.distance = grid_.face_distance;
  kernel.normal = grid_.face_normal;
  kernel.kind = face_kind_;
  kernel.states = states;
  kernel.outside = step.outside;
  kernel.inflow = step.inflow;
  kernel.fluxes = fluxes;
  Kokkos::parallel_for("thixis::flow::fluxes", Kokkos::RangePolicy<>(0, grid_.faces), kernel);
  return fluxes;
}

}  // namespace thixis::flow
