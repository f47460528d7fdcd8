#include "step/operator.hpp"

#include "step/vectors.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

algebra::MapPtr columns_of(const fv::Grid& grid) {
  std::vector<GlobalIndex> ids;
  ids.reserve(static_cast<std::size_t>(unknowns_per_cell) * grid.cells);
  for (LocalIndex K = 0; K < grid.cells; ++K)
    for (int u = 0; u < unknowns_per_cell; ++u) ids.push_back(unknowns_per_cell * grid.cell_id[K] + u);
  return algebra::map_of(ids, grid.comm);
}

struct UnknownsOf {
  StateValues at;
  decltype(std::declval<Vector&>().getLocalViewDevice(Tpetra::Access::OverwriteAll)) X;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const LocalIndex k = unknowns_per_cell * K;
    X(k + gas_saturation, 0) = at.s_g(K);
    X(k + pressure, 0) = at.P(K);
    X(k + dissolved, 0) = at.chi(K);
  }
};

struct StatesOf {
  TwoPhaseLaws laws;
  VectorIn X;
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
      laws_(two_phase_laws(scene)),
      scene_(grid_, scene, laws_, seconds_per_unit),
      cells_(algebra::map_of({grid_.cell_id.begin(), grid_.cell_id.begin() + grid_.owned_cells}, grid_.comm)),
      map_(algebra::interlaced(cells_, unknowns_per_cell)),
      column_map_(columns_of(grid_)),
      import_(Teuchos::rcp(new algebra::Import(map_, column_map_))) {}

Teuchos::RCP<Vector> TwoPhaseOperator::initial() const {
  const StateValues at = scene_.initial();
  const auto X = Teuchos::rcp(new Vector(map_));
  Kokkos::parallel_for("thixis::flow::initial", Cells(0, grid_.owned_cells),
                       UnknownsOf{at, X->getLocalViewDevice(Tpetra::Access::OverwriteAll)});
  return X;
}

FlowStep TwoPhaseOperator::step(double begin, double end, const Vector& before) const {
  FlowStep step;
  step.length = (end - begin) * scene_.seconds_per_unit();
  step.before = fv::View<double* [components]>("thixis::flow::masses_before", grid_.owned_cells);
  step.owed = fv::View<double* [components]>("thixis::flow::owed", grid_.owned_cells);
  step.source = fv::View<double* [components]>("thixis::flow::source", grid_.owned_cells);
  step.inflow = fv::View<double* [components]>("thixis::flow::inflow", grid_.faces);
  step.outside = fv::View<PhaseState*>("thixis::flow::outside", grid_.faces);
  scene_.set_data(begin, end, step);
  step.states_before = states(before);
  set_masses(step.states_before, step.before);
  return step;
}

void TwoPhaseOperator::set_masses(const fv::View<PhaseState*>& states, const fv::View<double* [components]>& masses) const {
  Kokkos::parallel_for("thixis::flow::masses", Cells(0, grid_.owned_cells), MassesOf{laws_, states, masses});
}

Vector TwoPhaseOperator::with_ghosts(const Vector& X) const {
  Vector all(column_map_);
  all.doImport(X, *import_, Tpetra::INSERT);
  return all;
}

fv::View<PhaseState*> TwoPhaseOperator::states(const Vector& X) const {
  const Vector all = with_ghosts(X);
  const fv::View<PhaseState*> states("thixis::flow::states", grid_.cells);
  Kokkos::parallel_for("thixis::flow::states", Cells(0, grid_.cells), StatesOf{laws_, read(all), states});
  return states;
}

fv::View<FaceFlux*> TwoPhaseOperator::fluxes(const fv::View<PhaseState*>& states, const FlowStep& step) const {
  const fv::View<FaceFlux*> fluxes("thixis::flow::fluxes", grid_.faces);
  FluxesOf kernel{laws_};
  kernel.face_cells = grid_.face_cells;
  kernel.distance = grid_.face_distance;
  kernel.normal = grid_.face_normal;
  kernel.kind = face_kind();
  kernel.states = states;
  kernel.outside = step.outside;
  kernel.inflow = step.inflow;
  kernel.fluxes = fluxes;
  Kokkos::parallel_for("thixis::flow::fluxes", Cells(0, grid_.faces), kernel);
  return fluxes;
}

}  // namespace thixis::flow
