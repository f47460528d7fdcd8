#pragma once
#include "estimate/broken_fluxes.hpp"

/// Norms in the cells; numbers in brackets are equations of docs/methods/two_phase_estimates.md.
namespace thixis::flow {

/// What a cell contributes, in this order; squares but for the last two.
struct Part {
  enum { space, in_time, linearization, algebraic, all_residuals, bent, appearing, disappearing, count };
};
constexpr int parts_of_cell = Part::count;

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
  fv::View<double* [parts_of_cell]> out;         ///< overwritten

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
    for (int i = 0; i < Part::count; ++i) out(K, i) = 0;
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
      out(K, Part::space) += here * here;
      out(K, Part::in_time) += cells.square(K, step) / (3 * mass[c] * mass[c]);
      out(K, Part::linearization) += lin * lin;
      out(K, Part::algebraic) += alg * alg;
      out(K, Part::all_residuals) += (here + lin + alg) * (here + lin + alg);
    }
    out(K, Part::bent) = distances(K, of_dissolved);
    const PhaseState &U = states(K), &B = states_before(K);
    const double G = laws.undersaturation(U) / content, G_before = laws.undersaturation(B) / content;
    out(K, Part::appearing) = cells.volume(K) * product(positive(U.s_g), positive(B.s_g), positive(G), positive(G_before));
    out(K, Part::disappearing) = cells.volume(K) * product(positive(-U.s_g), positive(-B.s_g), positive(-G), positive(-G_before));
  }
};

}  // namespace thixis::flow
