#pragma once
#include <vector>

#include "thixis/method/space.hpp"

namespace thixis::bound {

/// Three rows of cells along the held boundary: the cells that touch it, those that touch them, … Positions among the patch cells, in
/// their order. Collective: the owner of a cell knows all cells around it.
std::vector<LocalIndex> lift_layer(const method::Space& space, const std::vector<bool>& dirichlet);

}  // namespace thixis::bound
