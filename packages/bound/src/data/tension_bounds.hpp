#pragma once
#include <vector>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// A tension at the points of the space's quadrature, and bounds on it in each owned cell. Of a polynomial, sum_k b_k B_k in Bernstein
/// polynomials with b_k > 0, they hold everywhere in the cell: min b_k <= mu <= max b_k and, 1/mu being convex, 1/mu <= sum_k B_k/b_k. Of
/// others they are those of the points.
struct TensionBounds {
  std::vector<double> least, most;
  View<const double*> at_points;  ///< mu; of length 0 where it is constant
  View<double*> inverse;          ///< 1/mu from above, likewise
  bool proved = true;             ///< in all cells of all ranks
};

/// Collective; throws InputError where the tension is not positive at a quadrature point.
TensionBounds tension_bounds(const method::Space& space, const scene::Field& tension);

}  // namespace thixis::bound
