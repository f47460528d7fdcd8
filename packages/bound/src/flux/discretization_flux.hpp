#pragma once
#include <memory>
#include <vector>

#include "flux/membrane_flux.hpp"
#include "thixis/bound/contact_problem.hpp"
#include "thixis/equilibration/patch_flux.hpp"

namespace thixis::bound {

/// The multiplier as fluxes take it.
struct FluxMultiplier {
  ConstCellTable of_vertices;  ///< on patches (k, i dim P_q + m): density of what belongs to vertex i of patch cell k
  ConstCellTable at_held;      ///< else: moments against held functions, (patch cell, l); of length 0: none
};

/// The flux of the discretization of a membrane, with the divergence f - (-1)^alpha lambda^ less the residuals: on the patches of the
/// vertices the one nearest to -mu grad u_h (conforming spaces), elsewhere the one that the method has itself.
class DiscretizationFlux {
 public:
  /// The space must outlive it.
  DiscretizationFlux(const method::Space& space, int q, const std::vector<bool>& held);

  bool on_patches() const { return patches_ != nullptr; }
  /// Overwrites `of`.disc, from its data, stress and residuals. `rate`: a polynomial source to be taken from the force, densities on the
  /// patch cells; of length 0: none. Collective.
  void operator()(const ContactProblem& problem, const method::Coefficients& u, int alpha, const FluxMultiplier& lambda,
                  const ConstCellTable& rate, const MembraneFlux& of) const;
  std::size_t bytes() const;

 private:
  const method::Space& space_;
  std::unique_ptr<equilibration::PatchFlux> patches_;
  Kokkos::View<const double***, Kokkos::LayoutRight> times_;
  CellTable density_, target_;
};

}  // namespace thixis::bound
