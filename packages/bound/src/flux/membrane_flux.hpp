#pragma once
#include <memory>
#include <vector>

#include "data/sources.hpp"
#include "flux/residual_lift.hpp"
#include "flux/stress.hpp"

namespace thixis::bound {

/// What balances the forces on one membrane, sigma = disc + lin + alg, and how far it is from -mu grad u_h.
struct MembraneFlux {
  std::vector<double> least_tension;  ///< (owned cell)
  bool proved = false;                ///< TensionBounds::proved
  Sources data;
  std::unique_ptr<Stress> stress;
  CellTable w;              ///< (patch cell, 2 dim P_q): mu grad u_h
  CellTable disc;           ///< (owned cell, 2 dim P_{q+1})
  LiftedResidual lin, alg;  ///< of the part of the multiplier that is cut off, and of the residual
  Stress::Norms norms;
  View<double*> poincare;  ///< (owned cell): h_K/j mu^{-1/2}; of length 0 in conforming spaces, whose fluxes leave only data to it

  Stress::Fluxes fluxes() const { return {disc, alg.flux(), lin.flux()}; }
  /// The norms of w plus the fluxes; u: what w was made from.
  void measure(const method::Coefficients& u) const { stress->norms(u, w, fluxes(), norms); }
  std::size_t bytes() const;
};

/// Everything but the data. Collective.
MembraneFlux make_membrane_flux(const method::Space& space, int q, const scene::Field& tension, const ResidualLift& lift);

}  // namespace thixis::bound
