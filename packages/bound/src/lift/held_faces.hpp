#pragma once
#include <array>
#include <vector>

#include "lift/continuous_nodes.hpp"
#include "lift/lift_tables.hpp"

namespace thixis::bound {

/// What Dirichlet data have beyond their interpolant on the held faces of the patch cells, delta = g - g_h = s (1 - s) q(s) + rho.
struct HeldFaces {
  /// A cell with held faces, and q on each of them.
  struct Cell {
    LocalIndex position;  ///< among the patch cells
    LiftInCell l[2];
  };
  /// |||E|||_K of the extension of rho, over all held faces of an owned cell (BoundaryLift).
  struct Remainder {
    LocalIndex cell;
    double energy;
  };
  std::vector<Cell> cells;
  std::vector<Remainder> remainder;
  double largest = 0;  ///< of |delta| seen on this rank
  bool empty = true;   ///< delta is round-off
};

/// Of the data at `time`; `held`: coefficients of g_h on `nodes`. Not collective; throws on this rank only.
HeldFaces held_faces(const method::Space& space, const ContinuousNodes& nodes, const std::array<scene::FieldPtr, 2>& tension,
                     const std::array<method::BoundaryValues, 2>& boundary, const std::vector<double> (&held)[2], int count, double time);

}  // namespace thixis::bound
