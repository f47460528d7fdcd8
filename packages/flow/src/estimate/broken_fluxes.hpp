#pragma once
#include "step/operator.hpp"
#include "thixis/fv/raviart_thomas.hpp"

/// Fluxes in the cells, from one state in each; numbers in brackets are equations of docs/methods/two_phase_estimates.md.
namespace thixis::flow {

/// The functions whose gradients drive the phases and the dissolved hydrogen: P, P_g, chi.
enum Potential { of_liquid = 0, of_gas = 1, of_dissolved = 2 };
constexpr int potentials = 3;
constexpr int most_faces = fv::RaviartThomas::most_faces;

KOKKOS_INLINE_FUNCTION double potential(const PhaseState& U, int j) { return j == of_liquid ? U.P : j == of_gas ? U.P_g.value : U.chi; }

/// In the cells: the derivatives of the potentials across faces, outward, and the fluxes that they drive with the state of the cell. (3.1)
struct BrokenFluxes {
  fv::RaviartThomas cells;
  TwoPhaseLaws laws;
  fv::View<double*> distance;
  fv::View<FlowBoundaryKind*> kind;
  fv::View<PhaseState*> states, outside;
  fv::View<fv::Quadratic**> p;                        ///< out, overwritten: potentials of owned cells
  fv::View<double* [most_faces][components]> fluxes;  ///< out, overwritten: outward, of owned cells

  KOKKOS_FUNCTION double gravity(LocalIndex K, int f) const {
    const LocalIndex F = cells.face(K, f);
    return cells.sign(K, f) * (laws.gravity[0] * cells.normal(F, 0) + laws.gravity[1] * cells.normal(F, 1));
  }
  KOKKOS_FUNCTION bool given_flux(LocalIndex K, int f) const { return kind(cells.face(K, f)) == FlowBoundaryKind::flux; }

  /// Of potential j, but where the flux is given.
  KOKKOS_FUNCTION double derivative(LocalIndex K, int f, int j) const {
    const LocalIndex F = cells.face(K, f), L = cells.neighbour(K, f);
    const PhaseState& U = states(K);
    if (L >= 0) return (potential(states(L), j) - potential(U, j)) / distance(F);
    if (kind(F) == FlowBoundaryKind::state) return (potential(outside(F), j) - potential(U, j)) / distance(F);
    return j == of_liquid ? laws.rho_w * gravity(K, f) : j == of_gas ? laws.beta_g * U.P_g.value * gravity(K, f) : 0;
  }

  /// Where it is: that of a potential which does not bend along the normal.
  KOKKOS_FUNCTION double straight_on(LocalIndex K, int f, const double* g) const {
    if (!cells.triangles) {
      const int axis = cells.axis(cells.face(K, f));
      for (int e = 0; e < cells.count(K); ++e)
        if (e != f && cells.axis(cells.face(K, e)) == axis) return given_flux(K, e) ? 0 : -g[e];
      return 0;
    }
    double rest = 0;
    int unknown = 0;
    for (int e = 0; e < cells.count(K); ++e) {
      if (given_flux(K, e)) ++unknown;
      else rest += cells.area(cells.face(K, e)) * g[e];
    }
    return -rest / (unknown * cells.area(cells.face(K, f)));
  }

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const PhaseState& U = states(K);
    double g[potentials][most_faces] = {};
    for (int j = 0; j < potentials; ++j) {
      for (int f = 0; f < cells.count(K); ++f) g[j][f] = given_flux(K, f) ? 0 : derivative(K, f, j);
      for (int f = 0; f < cells.count(K); ++f)
        if (given_flux(K, f)) g[j][f] = straight_on(K, f, g[j]);
      p(K, j) = cells.potential(K, potential(U, j), g[j]);
    }
    for (int f = 0; f < cells.count(K); ++f) {
      const double down = gravity(K, f);
      const double q_l = laws.permeability * U.k_rl.value / laws.viscosity_l * (laws.rho_w * down - g[of_liquid][f]);
      const double q_g = laws.permeability * U.k_rg.value / laws.viscosity_g * (laws.beta_g * U.P_g.value * down - g[of_gas][f]);
      const double J = -laws.porosity * laws.beta_l * laws.diffusion * (1 - U.s_g) * g[of_dissolved][f];
      fluxes(K, f, water) = laws.rho_w * q_l - J;
      fluxes(K, f, hydrogen) = laws.beta_l * U.chi * q_l + laws.beta_g * U.P_g.value * q_g + J;
    }
  }
};

/// The potentials outside, on faces of kind state.
struct GivenPotentials {
  fv::View<FlowBoundaryKind*> kind;
  fv::View<PhaseState*> outside;
  fv::View<double**> values;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(LocalIndex F) const {
    for (int j = 0; j < potentials; ++j) values(F, j) = kind(F) == FlowBoundaryKind::state ? potential(outside(F), j) : 0;
  }
};

}  // namespace thixis::flow
