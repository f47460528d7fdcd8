#pragma once
#include "membrane_operator.hpp"

namespace thixis::models {

/// Sweeps of the projected Jacobi method, damped by 2/3, on x = (u1, u2, lambda): at every node both membranes move to balance their
/// forces; where they would pass through each other they stay together at the place of least energy, and lambda is the force that this
/// takes. Solutions of the contact problem are its fixed points. Collective: one exchange of ghosts a sweep.
void projected_jacobi(const MembraneOperator& membranes, int sweeps, algebra::MultiVector& x);

}  // namespace thixis::models
