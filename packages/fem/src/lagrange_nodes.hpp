#pragma once
#include "thixis/method/space.hpp"

namespace thixis::fem {

/// One entry per node of the patch cells, in the order in which the cells meet them: p-1 inside of each face, from its lower to its higher
/// vertex id, (p-1)(p-2)/2 inside of each cell. Identities: vertices, faces, cells.
method::Structure lagrange_nodes(const mesh::Mesh& mesh, const method::SpaceOptions& options);

}  // namespace thixis::fem
