#pragma once
#include <vector>

#include "thixis/algebra/fwd.hpp"

namespace thixis::algebra {

/// What a preconditioner may know of the nodes whose unknowns a system has, beside the matrix: all of it may be missing.
struct Nodes {
  Teuchos::RCP<const MultiVector> coordinates;  ///< a row for each node of this rank, a column for each direction
  /// Coarser functions, P_1, P_2, …: u = P_1 u_1 at the nodes, u_1 = P_2 u_2, …, down to the coarsest. Their columns begin with those of
  /// this rank, in the order of the domain (make_matrix).
  std::vector<Teuchos::RCP<const Matrix>> below;
};

}  // namespace thixis::algebra
