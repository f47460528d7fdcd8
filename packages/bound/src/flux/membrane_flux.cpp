#include "flux/membrane_flux.hpp"

#include <cmath>

#include "data/tables.hpp"
#include "data/tension_bounds.hpp"

namespace thixis::bound {

MembraneFlux make_membrane_flux(const method::Space& space, int q, const scene::Field& tension, const ResidualLift& lift) {
  const LocalIndex owned = space.mesh().owned_cells;
  const TensionBounds bounds = tension_bounds(space, tension);
  MembraneFlux of;
  of.least_tension = bounds.least;
  of.proved = bounds.proved;
  of.stress = make_stress(space, q, tension, bounds);
  of.w = CellTable("thixis::bound::stress", space.cells().extent(0), 2 * reference::dimension(q));
  of.disc = CellTable("thixis::bound::sigma_disc", owned, 2 * reference::dimension(q + 1));
  of.alg = lift.make(owned);
  of.lin = lift.make(owned);
  for (View<double*>* norm : {&of.norms.whole, &of.norms.disc, &of.norms.alg, &of.norms.lin})
    *norm = View<double*>("thixis::bound::flux_norm", owned);
  if (space.conforming()) return of;
  std::vector<double> factor = diameters(space.mesh());
  for (LocalIndex K = 0; K < owned; ++K) factor[K] *= poincare / std::sqrt(of.least_tension[K]);
  of.poincare = to_view("thixis::bound::poincare", factor);
  return of;
}

std::size_t MembraneFlux::bytes() const {
  return sizeof(double) * (data.force.size() + w.size() + disc.size() + alg.r.size() + alg.sigma.size() + lin.r.size() + lin.sigma.size() +
                           4 * norms.whole.size() + poincare.size());
}

}  // namespace thixis::bound
