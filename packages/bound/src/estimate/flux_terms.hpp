#pragma once
#include "estimate/sums.hpp"
#include "flux/membrane_flux.hpp"
#include "thixis/bound/guaranteed_bound.hpp"

namespace thixis::bound {

/// What the flux of one membrane adds to the square of a bound.
struct OfFlux {
  enum { whole, disc, lin, alg, change, count };
};

/// With a = |mu^{1/2} grad u_h + mu^{-1/2} sigma|_K, in a step that in its middle, c = |mu^{1/2} grad (u_h - u_before)|_K (else 0), and osc
/// what data, multiplier and rate of change leave to be bounded by h_K/j mu^{-1/2} |·|_K,
///
///     whole += ((a² + c²/12)^{1/2} + osc)²,      ∫_0^1 |v + (theta - 1/2) w|² = |v|² + |w|²/12;
///
/// `disc` likewise with sigma_disc alone; `lin`, `alg`: |mu^{-1/2} sigma|²_K of the lifted residuals; `change`: c²/3.
struct FluxTerms {
  Stress::Norms norms;
  View<const double*> volume, traction;  ///< Sources::sharp_oscillation, traction_oscillation
  View<const double*> poincare;          ///< h_K/j mu^{-1/2}, the factor of the next two; of length 0 where neither is there
  View<const double*> of_multiplier;     ///< MultiplierFit::rest
  View<const double*> of_rate;           ///< |(1 - Pi_q) ∂_t s_N|_K; of length 0: no step
  View<const double*> change;            ///< c; of length 0: no step
  struct Cells {
    View<double*> disc, lin, alg;
  } add;  ///< in and out: each cell's terms are added; of length 0: to nothing

  KOKKOS_FUNCTION double oscillation(int K) const;
  KOKKOS_FUNCTION void operator()(int K, Sums<OfFlux>& sum) const;
};

/// What is there in every bound; `of_multiplier`: MultiplierFit::rest.
FluxTerms flux_terms(const MembraneFlux& of, const View<const double*>& of_multiplier);

}  // namespace thixis::bound
