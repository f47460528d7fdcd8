#pragma once
#include "deviation/deviation_of_cells.hpp"
#include "lift/boundary_lift.hpp"

namespace thixis::bound {

/// D of two membranes: in the layer of the lift, at the points of a composite rule. On held faces D up to `noise` is none.
Deviation deviation_of_membranes(const method::Space& space, const BoundaryLift& lift, const std::vector<bool>& dirichlet, double noise);

/// D over an obstacle, at the points of the space's quadrature, which knows where psi has its kinks. Nothing where psi is its interpolant
/// to round-off. The gradient of psi is taken by differences. `psi`: coefficients of the interpolant; where psi jumps inside a cell, of its
/// majorant, which takes its place there.
Deviation deviation_of_obstacle(const method::Space& space, const BoundaryLift& lift, const ContinuousNodes& nodes,
                                const scene::FieldPtr& obstacle, const std::vector<double>& psi, const method::Jumps& jumps,
                                const std::vector<bool>& dirichlet);

/// What the majorant has above the obstacle in cells in which that jumps, at the points of the space's quadrature.
Excess excess_of_majorant(const method::Space& space, const ContinuousNodes& nodes, const scene::Field& obstacle,
                          const std::vector<double>& majorant, const method::Jumps& jumps);

}  // namespace thixis::bound
