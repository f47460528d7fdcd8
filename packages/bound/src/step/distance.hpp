#pragma once
#include <array>

#include "estimate/bound_parts.hpp"

namespace thixis::bound {

/// |u_alpha - s_alpha| of functions of the space and their feasible pair: |u_h - s_N| + |L| + |what is moved apart|. `moved`: scratch,
/// (owned cell). Collective.
std::array<double, 2> distance(const BoundParts& parts, const FeasiblePair& pair, const method::Coefficients (&u)[2],
                               const View<double*>& moved);

}  // namespace thixis::bound
