#include "flux/residual_lift.hpp"

#include <utility>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::bound {

ResidualLift::ResidualLift(const CellShares& shares, mesh::Ancestry ancestry, const core::Comm& comm, const std::vector<bool>& held, int q)
    : shares_(shares), flux_(2 * reference::dimension(q + 1)), through_levels_(std::move(ancestry), comm, held, q) {}

LiftedResidual ResidualLift::make(LocalIndex owned_cells) const {
  LiftedResidual of;
  of.r = shares_.make_density("thixis::bound::residual");
  of.sigma = CellTable("thixis::bound::lifted", owned_cells, flux_);
  return of;
}

void ResidualLift::represent(const algebra::Vector& R, LiftedResidual& of) const {
  const bool had = std::exchange(of.has_r, !vanishes(R));
  if (of.has_r) {
    shares_(R);
    shares_.represent(of.r);
  } else if (had) {
    Kokkos::deep_copy(of.r, 0);
  }
}

void ResidualLift::lift(const ConstCellTable& r, LiftedResidual& of) const {
  of.left = flux(r, of.sigma);
  of.has_sigma = true;
}

void ResidualLift::operator()(const algebra::Vector& R, LiftedResidual& of) const {
  represent(R, of);
  if (of.has_r) return lift(of);
  if (std::exchange(of.has_sigma, false)) Kokkos::deep_copy(of.sigma, 0);
  of.left = 0;
}

}  // namespace thixis::bound
