#pragma once
#include "membrane_operator.hpp"

namespace thixis::models {

/// Sweeps of the projected Jacobi method, damped by 2/3, at the contact points of x: at every node the membranes move to balance their
/// forces; where they would pass through each other they stay together at the place of least energy (one membrane: on the obstacle), and
/// lambda is the force that this takes. Solutions of the contact problem are its fixed points. Collective: one exchange of ghosts a sweep.
void projected_jacobi(const MembraneOperator& membranes, int sweeps, Fields& x);

}  // namespace thixis::models
