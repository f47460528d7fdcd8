#pragma once
#include "constrained_solver.hpp"

namespace thixis::models {

/// Static condensation inside each set_matrix: the cells' matrices are formed anew, contact points cleared in them, and what belongs to one
/// cell alone is eliminated; the Krylov method sees the Schur complement.
std::unique_ptr<ConstrainedSolver> make_condensed_solver(const MembraneOperator& membranes, const Blocks& blocks,
                                                         const algebra::LinearParams& params,
                                                         const Teuchos::RCP<const algebra::MultiVector>& coordinates);

}  // namespace thixis::models
