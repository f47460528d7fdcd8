#include "flux/cell_shares.hpp"

#include "data/tables.hpp"
#include "flux/flux_sources.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::bound {

bool vanishes(const algebra::Vector& v) { return v.normInf() == 0; }

CellShares::CellShares(const method::Space& space, int q)
    : space_(space),
      n_(reference::dimension(q)),
      moments_("thixis::bound::moments", space.cells().extent(0), space.basis().size()),
      from_moments_(matrix_view("thixis::bound::from_moments", space.basis().size(), space.basis().size(),
                                from_moments(space.basis(), reference::Modal(space.basis().degree())))) {}

const CellTable& CellShares::operator()(const algebra::Vector& R) const {
  space_.share(R, moments_);
  return moments_;
}

void CellShares::represent(const CellTable& r) const {
  Kokkos::parallel_for("thixis::bound::represent", Kokkos::RangePolicy<>(0, moments_.extent_int(0)), Represent{moments_, from_moments_, r});
}

}  // namespace thixis::bound
