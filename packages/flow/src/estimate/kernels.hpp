#pragma once
#include "laws/settle.hpp"
#include "step/operator.hpp"
#include "thixis/fv/raviart_thomas.hpp"

/// Kernels of the estimate of two-phase flow; numbers in brackets are equations of docs/methods/two_phase_estimates.md.
namespace thixis::flow {

/// The functions whose gradients drive the phases and the dissolved hydrogen: P, P_g, chi.
enum Potential { of_liquid = 0, of_gas = 1, of_dissolved = 2 };
constexpr int potentials = 3;
constexpr int most_faces = fv::RaviartThomas::most_faces;

KOKKOS_INLINE_FUNCTION double potential(const PhaseState& U, int j) { return j == of_liquid ? U.P : j == of_gas ? U.P_g.value : U.chi; }

/// Masses and face fluxes, of a state or linearized at another one.
struct Balanced {
  fv::View<double*[components]> masses, fluxes;
};

/// l_c and Phi_c at U.
struct MassesAt {
  TwoPhaseLaws laws;
  fv::View<PhaseState*> states;
  fv::View<double* [components]> masses;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const Masses l = laws.masses(states(K));
    for (int c = 0; c < components; ++c) masses(K, c) = l.value[c];
  }
};

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

/// (l_c - before)/tau + sum_F ± |F| Phi_c/|K| - Q_c                                                                       (2.2)
struct Residual {
  fv::RaviartThomas cells;
  Balanced balanced;
  fv::View<double*[components]> before, source;
  double length;

  KOKKOS_FUNCTION double operator()(LocalIndex K, int c) const {
    double g[most_faces];
    for (int f = 0; f < cells.count(K); ++f) g[f] = cells.sign(K, f) * balanced.fluxes(cells.face(K, f), c);
    return (balanced.masses(K, c) - before(K, c)) / length + cells.divergence(K, g) - source(K, c);
  }
};

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

/// What a cell contributes, in this order; squares but for the last two.
enum Part { space, in_time, linearization, algebraic, all_residuals, bent, appearing, disappearing };
constexpr int parts = 8;

/// Squared norms of a cell, by component divided by its mass.                                                            (5.1)
struct CellErrors {
  fv::RaviartThomas cells;
  TwoPhaseLaws laws;
  double mass[components], content;  ///< content: what G is divided by
  double length;
  bool lifted;  ///< linearization: the flux given holds all of it; else its masses count as well
  fv::View<double*> diameter;
  fv::View<PhaseState*> states, states_before;
  fv::View<double* [components]> face_fluxes;  ///< of the scheme, at `states`
  fv::View<double*[most_faces][components]> fluxes, fluxes_before;
  fv::View<double**> distances;                  ///< |grad (p_j - average)|²
  fv::View<double**> sigma, rest;                ///< columns: linearization w, h, algebraic w, h
  fv::View<double* [components]> masses_missed;  ///< l_c(U) - l_c(V) - l_c'(V) (U - V); not read where lifted
  fv::View<double* [parts]> out;                 ///< overwritten

  KOKKOS_FUNCTION double lift(LocalIndex K, int column, int c) const {
    double g[most_faces];
    for (int f = 0; f < cells.count(K); ++f) g[f] = cells.sign(K, f) * sigma(cells.face(K, f), column);
    return Kokkos::Experimental::sqrt(cells.square(K, g) + rest(K, column)) / mass[c];
  }

  KOKKOS_FUNCTION double nonconformity(LocalIndex K, int c) const {
    const PhaseState& U = states(K);
    const double liquid = laws.permeability * U.k_rl.value / laws.viscosity_l, gas = laws.permeability * U.k_rg.value / laws.viscosity_g;
    double n[potentials];
    for (int j = 0; j < potentials; ++j) n[j] = Kokkos::Experimental::sqrt(distances(K, j));
    const double diffusion = laws.porosity * laws.beta_l * laws.diffusion * Kokkos::Experimental::fabs(1 - U.s_g) * n[of_dissolved];
    if (c == water) return (laws.rho_w * liquid * n[of_liquid] + diffusion) / mass[c];
    return (laws.beta_l * Kokkos::Experimental::fabs(U.chi) * liquid * n[of_liquid] +
            laws.beta_g * Kokkos::Experimental::fabs(U.P_g.value) * gas * n[of_gas] + diffusion) /
           mass[c];
  }

  /// ∫ a^+ b^+ over the step by the part of the affine functions at its ends, per length of the step.
  KOKKOS_FUNCTION static double product(double a0, double a1, double b0, double b1) {
    return (2 * a0 * b0 + a0 * b1 + a1 * b0 + 2 * a1 * b1) / 6;
  }
  KOKKOS_FUNCTION static double positive(double a) { return a > 0 ? a : 0; }

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    for (int i = 0; i < parts; ++i) out(K, i) = 0;
    for (int c = 0; c < components; ++c) {
      double off[most_faces], step[most_faces];
      for (int f = 0; f < cells.count(K); ++f) {
        off[f] = cells.sign(K, f) * face_fluxes(cells.face(K, f), c) - fluxes(K, f, c);
        step[f] = fluxes(K, f, c) - fluxes_before(K, f, c);
      }
      const double here = Kokkos::Experimental::sqrt(cells.square(K, off)) / mass[c] + nonconformity(K, c);
      double lin = lift(K, c, c);
      if (!lifted)
        lin +=
            diameter(K) / length * Kokkos::Experimental::sqrt(cells.volume(K)) * Kokkos::Experimental::fabs(masses_missed(K, c)) / mass[c];
      const double alg = lift(K, components + c, c);
      out(K, space) += here * here;
      out(K, in_time) += cells.square(K, step) / (3 * mass[c] * mass[c]);
      out(K, linearization) += lin * lin;
      out(K, algebraic) += alg * alg;
      out(K, all_residuals) += (here + lin + alg) * (here + lin + alg);
    }
    out(K, bent) = distances(K, of_dissolved);
    const PhaseState &U = states(K), &B = states_before(K);
    const double G = laws.undersaturation(U) / content, G_before = laws.undersaturation(B) / content;
    out(K, appearing) = cells.volume(K) * product(positive(U.s_g), positive(B.s_g), positive(G), positive(G_before));
    out(K, disappearing) = cells.volume(K) * product(positive(-U.s_g), positive(-B.s_g), positive(-G), positive(-G_before));
  }
};

}  // namespace thixis::flow
