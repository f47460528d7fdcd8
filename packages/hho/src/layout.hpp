#pragma once
#include "thixis/method/space.hpp"

namespace thixis::hho {

/// Entries: the coefficients of all patch cells, then p of each of their faces, in the order in which the cells meet them.
method::Structure layout(const mesh::Mesh& mesh, const method::SpaceOptions& options);

}  // namespace thixis::hho
