#include "step/turnover.hpp"

#include <cmath>
#include <limits>

#include "step/vectors.hpp"

namespace thixis::flow {
namespace {

/// The faces around a cell, with |F|/|K|.
struct Faces {
  fv::View<LocalIndex*> begin, faces;
  fv::View<double*> area, volume, distance;
  fv::View<LocalIndex* [2]> cells;

  explicit Faces(const fv::Grid& grid)
      : begin(grid.cell_face_begin),
        faces(grid.cell_faces),
        area(grid.face_area),
        volume(grid.volume),
        distance(grid.face_distance),
        cells(grid.face_cells) {}

  template <class Term>
  KOKKOS_INLINE_FUNCTION double sum(LocalIndex K, const Term& term) const {
    double all = 0;
    for (LocalIndex f = begin(K); f < begin(K + 1); ++f) all += area(faces(f)) / volume(K) * term(faces(f));
    return all;
  }
};

/// Sum of the squares of what is moved in the cells.
struct Moved {
  Faces around;
  fv::View<FaceFlux*> fluxes;
  fv::View<double* [components]> source;
  double length;
  int component;

  KOKKOS_FUNCTION void operator()(LocalIndex K, double& squares) const {
    const double moved = length * (Kokkos::Experimental::fabs(source(K, component)) +
                                   around.sum(K, [&](LocalIndex F) { return Kokkos::Experimental::fabs(fluxes(F).value[component]); }));
    squares += moved * moved;
  }
};

/// Sum of the squares of the terms whose differences make masses and fluxes, with the state of the cell on both sides of its faces.
struct Terms {
  Faces around;
  TwoPhaseLaws laws;
  fv::View<PhaseState*> states;
  double length;
  int component;

  KOKKOS_FUNCTION void operator()(LocalIndex K, double& squares) const {
    const PhaseState& U = states(K);
    const double chi = laws.beta_l * Kokkos::Experimental::fabs(U.chi), P_g = Kokkos::Experimental::fabs(U.P_g.value);
    const double liquid = laws.permeability * U.k_rl.value / laws.viscosity_l * Kokkos::Experimental::fabs(U.P);
    const double gas = laws.permeability * U.k_rg.value / laws.viscosity_g * P_g;
    const double diffusion = laws.porosity * laws.diffusion * chi;
    const double flux = diffusion + (component == water ? laws.rho_w * liquid : chi * liquid + laws.beta_g * P_g * gas);
    const double across = length * flux * around.sum(K, [&](LocalIndex F) { return around.cells(F, 1) < 0 ? 0 : 1 / around.distance(F); });
    const double mass = Kokkos::Experimental::fabs(laws.masses(U).value[component]);
    squares += (mass + across) * (mass + across);
  }
};

}  // namespace

Turnover turnover(const TwoPhaseOperator& flow, const FlowStep& step) {
  const auto fluxes = flow.fluxes(step.states_before, step);
  const Faces around(flow.grid());
  std::vector<double> squares(2 * components, 0);
  for (int c = 0; c < components; ++c) {
    Kokkos::parallel_reduce("thixis::flow::moved", Cells(0, flow.grid().owned_cells), Moved{around, fluxes, step.source, step.length, c},
                            squares[c]);
    Kokkos::parallel_reduce("thixis::flow::terms", Cells(0, flow.grid().owned_cells),
                            Terms{around, flow.laws(), step.states_before, step.length, c}, squares[components + c]);
  }
  flow.grid().comm.sum(squares);
  Turnover of;
  for (int c = 0; c < components; ++c) {
    of.moved[c] = std::sqrt(squares[c]);
    of.rounding[c] = std::numeric_limits<double>::epsilon() * std::sqrt(squares[components + c]);
  }
  return of;
}

}  // namespace thixis::flow
