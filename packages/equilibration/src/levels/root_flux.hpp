#pragma once
#include <memory>
#include <vector>

#include "thixis/equilibration/cell_fields.hpp"
#include "thixis/equilibration/patch_flux.hpp"
#include "thixis/mesh/mesh.hpp"

namespace thixis::equilibration {

/// The flux on the coarsest mesh, which this rank holds whole: with rho in P_1, zero on the held boundary,
///
///     (grad rho, grad psi_a) = (r, psi_a)  for all free vertices a,
///     sigma = sum_a sigma_a,   sigma_a nearest to -psi_a grad rho with div sigma_a = psi_a r - grad rho · grad psi_a.
///
/// On a piece of the mesh of which nothing is held no flux has a divergence with a mean: there r is taken without its own.
class RootFlux {
 public:
  RootFlux(std::shared_ptr<const mesh::Mesh> mesh, const std::vector<bool>& held, int q);
  ~RootFlux();
  /// r: (cell, dim P_q); overwrites sigma (cell, 2 dim P_{q+1}). Returns |r - div sigma|, of the means that were left out.
  double operator()(const ConstCellTable& r, const CellTable& sigma) const;
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::equilibration
