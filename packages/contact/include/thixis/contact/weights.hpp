#pragma once
#include <vector>

#include "thixis/contact/system.hpp"

namespace thixis::contact {

/// By what the rows of a contact problem are measured:
///
///     |R|² = sum_i (field_i |R_i|)² + sum_pg (contact kappa_pg C_pg)².
struct Weights {
  std::vector<double> field;
  double contact = 1;
  Teuchos::RCP<const algebra::MultiVector> stiffness;  ///< kappa, on the contact points, a column for each gap
};

/// kappa_pg, 1/kappa = Bᵀ diag(S)^{-1} B: the force that opens a gap by one where all else keeps its place. On the contact points, a column
/// for each gap. diagonals: S_ii,ll, a column for each field.
Teuchos::RCP<const algebra::MultiVector> stiffness_of_gaps(const System& system, const algebra::MultiVector& diagonals);

}  // namespace thixis::contact
