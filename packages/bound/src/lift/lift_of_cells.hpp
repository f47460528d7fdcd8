#pragma once
#include "thixis/bound/cell_fields.hpp"

namespace thixis::bound {

/// The lift L_alpha of what the boundary data have beyond their interpolant, as
/// cells see it: integrals that depend on the mesh only.
struct LiftOfCells {
  View<const LocalIndex*> place;                                ///< of each owned cell, -1 where there is
                                                                ///< none; of length 0: nowhere
  View<const double* [2]> energy;                               ///< (place, alpha): |||L_alpha|||²_K
  Kokkos::View<const double***, Kokkos::LayoutRight> products;  ///< (place, alpha, k): (mu_alpha grad L_alpha, grad B_k)_K
  KOKKOS_FUNCTION LocalIndex operator()(LocalIndex K) const { return place.extent(0) == 0 ? -1 : place(K); }
};

}  // namespace thixis::bound
