#pragma once
/// What is in the library that is loaded when multigrid is first asked for. It holds MueLu and nothing of the other packages.
#include "thixis/algebra/fwd.hpp"

namespace thixis::algebra {

/// Systems of this size are factorized: the coarsest level, and the whole matrix if no more rows are coupled.
constexpr int coarse_rows = 500;

/// Collective. cycle <- a cycle of smoothed aggregation for A; the others as in Preconditioner::set_matrix. Throws what MueLu throws.
using MueluCycle = void(const Teuchos::RCP<Matrix>& A, int fields, const Teuchos::RCP<const MultiVector>& coordinates,
                        Teuchos::RCP<const Operator>& cycle);
constexpr const char* muelu_cycle_name = "thixis_muelu_cycle";

}  // namespace thixis::algebra
