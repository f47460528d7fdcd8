#pragma once
#include <memory>
#include <vector>

#include "thixis/equilibration/cell_fields.hpp"
#include "thixis/mesh/ancestry.hpp"

namespace thixis::equilibration {

/// Fluxes of RT_q with a given divergence, by the hierarchy of meshes (docs/methods/estimates.md, 2): with Pi_j the projection on the
/// polynomials of degree q in the cells of level j,
///
///     sigma = sigma_0 + sum_{j >= 1} sigma_j,   div sigma_0 = Pi_0 r,   div sigma_j = (Pi_j - Pi_{j-1}) r.
///
/// sigma_0 equilibrates the solution rho of a Poisson problem in P_1 on the coarsest mesh; sigma_j does not leave the cells of level
/// j - 1, in whose children it is the smallest such flux in reference coordinates: a small matrix for each way of cutting a cell.
class MultilevelFlux {
 public:
  /// `held`: per boundary tag, where the flux may leave. Collective.
  MultilevelFlux(mesh::Ancestry ancestry, const core::Comm& comm, const std::vector<bool>& held, int q);
  ~MultilevelFlux();
  MultilevelFlux(const MultilevelFlux&) = delete;
  MultilevelFlux& operator=(const MultilevelFlux&) = delete;

  /// div sigma = r on the owned cells: r (cell, at least dim P_q) and sigma (cell, 2 dim P_{q+1}) in modal coefficients; r as density.
  /// Overwrites sigma. Collective. On pieces of the mesh that nothing holds r loses its mean: returns |r - div sigma|, else 0.
  double operator()(const ConstCellTable& r, const CellTable& sigma) const;

  std::size_t bytes() const;  ///< held for the mesh

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::equilibration
