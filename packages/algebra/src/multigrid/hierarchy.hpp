#pragma once
#include <memory>

#include "method.hpp"

namespace thixis::algebra {

/// A V-cycle over the coarser functions that the nodes know (Nodes::below), truncated at decoupled rows (contact, conditions), with one
/// Gauss-Seidel sweep before and the adjoint one after each correction: symmetric, positive definite with A. The coarsest system is
/// factorized if it is small, else left to MueLu. Patterns are found once per graph; new values need products with them alone.
/// Needs a diagonal without zeros (throws core::InputError).
std::unique_ptr<Preconditioner> make_multigrid();

}  // namespace thixis::algebra
