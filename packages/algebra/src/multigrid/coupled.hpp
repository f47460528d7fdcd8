#pragma once
#include <string>

#include "thixis/algebra/fwd.hpp"

namespace thixis::algebra {

/// 1 for a row with an off-diagonal entry that is not zero, else 0. Decoupled rows are conditions like u = g or u2 = u1 at some nodes.
Vector coupled_rows(const Matrix& A);

/// Throws core::InputError where the diagonal has a zero. Collective. `name`: of the preconditioner in the deck.
void require_diagonal(const Matrix& A, const std::string& name);

}  // namespace thixis::algebra
