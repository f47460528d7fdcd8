#pragma once
#include <memory>
#include <string>

#include "method.hpp"

namespace thixis::algebra {

/// Algebraic multigrid by smoothed aggregation (MueLu) with Chebyshev smoothers, symmetric, for matrices like those of elliptic equations.
/// P. Vanek, J. Mandel, M. Brezina (1996), doi:10.1007/BF02238511. Needs a diagonal without zeros, and the unknowns of a node side by side
/// (throws core::InputError).
/// `name`: what the deck asked for.
std::unique_ptr<Preconditioner> make_aggregation(const std::string& name);

}  // namespace thixis::algebra
