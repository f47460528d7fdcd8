#pragma once
#include "linearized_system.hpp"
#include "membrane_measure.hpp"

namespace thixis::models {

/// The multiplier eliminated, in the variables
///
///     w = theta1 u1 + theta2 u2,   z = u1 - u2      (u1 = w + theta2 z,  u2 = w - theta1 z),
///
/// in which contact is a Dirichlet condition on z and every system is as definite, and as symmetric, as S1 and S2:
///
///     [ S1 + S2,  theta2 S1 - theta1 S2 ;  theta2 S1 - theta1 S2,  theta2² S1 + theta1² S2 + D a/b ] (dw, dz) = …
///
/// With constant tensions the coupling vanishes: one Poisson problem for w, its solver set up once, and a scalar obstacle problem for z.
/// One membrane over an obstacle is the latter alone: z = u, theta = (0, 1). Points with D a >= 1e10 diag b are in contact: dz = -C/a, and
/// their multiplier follows from equilibrium.
///
/// Where the operator is condensed, so is each of these systems.
std::unique_ptr<LinearizedSystem> make_reduced_system(const MembraneOperator& membranes, const MembraneMeasure& measure,
                                                      const algebra::LinearParams& params,
                                                      const Teuchos::RCP<const algebra::MultiVector>& coordinates);

}  // namespace thixis::models
