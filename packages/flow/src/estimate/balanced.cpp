#include "estimate/balanced.hpp"

#include "step/vectors.hpp"

namespace thixis::flow {
namespace {

/// U - V, in the order of Unknown.
KOKKOS_INLINE_FUNCTION void difference(const PhaseState& U, const PhaseState& V, double d[unknowns_per_cell]) {
  d[gas_saturation] = U.s_g - V.s_g;
  d[pressure] = U.P - V.P;
  d[dissolved] = U.chi - V.chi;
}

/// l_c(V) + l_c'(V) (U - V)
struct LinearizedMasses {
  TwoPhaseLaws laws;
  fv::View<PhaseState*> states, at;
  fv::View<double* [components]> masses;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const Masses l = laws.masses(at(K));
    double d[unknowns_per_cell];
    difference(states(K), at(K), d);
    for (int c = 0; c < components; ++c) {
      masses(K, c) = l.value[c];
      for (int u = 0; u < unknowns_per_cell; ++u) masses(K, c) += l.d[c][u] * d[u];
    }
  }
};

/// Phi_c(V) + Phi_c'(V) (U - V)
struct LinearizedFluxes {
  fv::View<LocalIndex* [2]> face_cells;
  fv::View<PhaseState*> states, at;
  fv::View<FaceFlux*> fluxes_at;
  fv::View<double* [components]> fluxes;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(LocalIndex F) const {
    const FaceFlux& flux = fluxes_at(F);
    const LocalIndex A = face_cells(F, 0), B = face_cells(F, 1);
    double d_A[unknowns_per_cell], d_B[unknowns_per_cell] = {0, 0, 0};
    difference(states(A), at(A), d_A);
    if (B >= 0) difference(states(B), at(B), d_B);
    for (int c = 0; c < components; ++c) {
      double value = flux.value[c];
      for (int u = 0; u < unknowns_per_cell; ++u) value += flux.by_first[c][u] * d_A[u] + flux.by_second[c][u] * d_B[u];
      fluxes(F, c) = value;
    }
  }
};

Balanced allocate(const fv::Grid& grid) {
  return {fv::View<double* [components]>("thixis::flow::masses", grid.owned_cells),
          fv::View<double* [components]>("thixis::flow::flux_values", grid.faces)};
}

}  // namespace

Balanced balanced(const TwoPhaseOperator& flow, const FlowStep& step, const fv::View<PhaseState*>& states) {
  const Balanced out = allocate(flow.grid());
  flow.set_masses(states, out.masses);
  const auto fluxes = flow.fluxes(states, step);
  const auto values = out.fluxes;
  Kokkos::parallel_for(
      "thixis::flow::flux_values", Cells(0, flow.grid().faces), KOKKOS_LAMBDA(LocalIndex F) {
        for (int c = 0; c < components; ++c) values(F, c) = fluxes(F).value[c];
      });
  return out;
}

Balanced linearized(const TwoPhaseOperator& flow, const fv::View<PhaseState*>& states, const Linearization& at) {
  const fv::Grid& grid = flow.grid();
  const Balanced out = allocate(grid);
  Kokkos::parallel_for("thixis::flow::linearized_masses", Cells(0, grid.owned_cells),
                       LinearizedMasses{flow.laws(), states, at.states, out.masses});
  Kokkos::parallel_for("thixis::flow::linearized_fluxes", Cells(0, grid.faces),
                       LinearizedFluxes{grid.face_cells, states, at.states, at.fluxes, out.fluxes});
  return out;
}

}  // namespace thixis::flow
