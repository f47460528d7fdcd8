#pragma once
#include "problem/jacobian.hpp"
#include "thixis/fv/raviart_thomas.hpp"

/// What the balances of cells leave; numbers in brackets are equations of docs/methods/two_phase_estimates.md.
namespace thixis::flow {

/// Masses and face fluxes, of a state or linearized at another one.
struct Balanced {
  fv::View<double*[components]> masses, fluxes;
};

/// l_c in the owned cells and Phi_c on the faces, at U.
Balanced balanced(const TwoPhaseOperator& flow, const FlowStep& step, const fv::View<PhaseState*>& states);
/// l_c(V) + l_c'(V) (U - V), and Phi_c likewise.
Balanced linearized(const TwoPhaseOperator& flow, const fv::View<PhaseState*>& states, const Linearization& at);

/// (l_c - before)/tau + sum_F ± |F| Phi_c/|K| - Q_c                                                                       (2.2)
struct Residual {
  fv::RaviartThomas cells;
  Balanced balanced;
  fv::View<double*[components]> before, source;
  double length;

  KOKKOS_FUNCTION double operator()(LocalIndex K, int c) const {
    double g[fv::RaviartThomas::most_faces];
    for (int f = 0; f < cells.count(K); ++f) g[f] = cells.sign(K, f) * balanced.fluxes(cells.face(K, f), c);
    return (balanced.masses(K, c) - before(K, c)) / length + cells.divergence(K, g) - source(K, c);
  }
};

}  // namespace thixis::flow
