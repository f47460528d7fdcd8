#pragma once
#include <memory>
#include <vector>

#include "flux/cell_shares.hpp"
#include "thixis/equilibration/multilevel_flux.hpp"

namespace thixis::bound {

/// A residual as a polynomial of degree q in every patch cell, and a flux with that divergence.
struct LiftedResidual {
  CellTable r;                            ///< (patch cell, dim P_q): densities
  CellTable sigma;                        ///< (owned cell, 2 dim P_{q+1}): div sigma = r on the owned cells
  bool has_r = false, has_sigma = false;  ///< else they are 0
  double left = 0;                        ///< |r - div sigma|, of means that no flux takes away (MultilevelFlux)

  /// Of length 0 where there is none.
  ConstCellTable flux() const { return has_sigma ? ConstCellTable(sigma) : ConstCellTable(); }
};

/// Lifts residuals by the hierarchy of meshes.
class ResidualLift {
 public:
  /// The space and the shares must outlive it. Collective.
  ResidualLift(const CellShares& shares, mesh::Ancestry ancestry, const core::Comm& comm, const std::vector<bool>& held, int q);

  LiftedResidual make(LocalIndex owned_cells) const;
  /// r of a functional on the space. Collective.
  void represent(const algebra::Vector& R, LiftedResidual& of) const;
  /// The flux of densities `of`.r, or of others. Collective.
  void lift(LiftedResidual& of) const { lift(of.r, of); }
  void lift(const ConstCellTable& r, LiftedResidual& of) const;
  /// Both. Collective.
  void operator()(const algebra::Vector& R, LiftedResidual& of) const;
  /// div sigma = r on the owned cells; returns |r - div sigma|. Collective.
  double flux(const ConstCellTable& r, const CellTable& sigma) const { return through_levels_(r, sigma); }
  std::size_t bytes() const { return through_levels_.bytes(); }

 private:
  const CellShares& shares_;
  int flux_;  ///< 2 dim P_{q+1}
  equilibration::MultilevelFlux through_levels_;
};

}  // namespace thixis::bound
