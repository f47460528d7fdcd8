#pragma once
#include <cstdint>
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// The longest face of each cell, in the physical domain; of equally long ones that with the lowest ids of vertices.
std::vector<std::uint8_t> longest_faces(const Mesh& mesh);

/// The next level of a mesh that is whole on this rank, ids = local numbers. `marked`: cells, `edge`: refinement edge of each cell,
/// replaced by those of the new level.
///
/// Marked are the three faces of marked cells, and of every cell with a marked face the refinement edge. A cell is bisected by its
/// refinement edge if that is marked, its halves by their refinement edges (the other two faces of the cell) where those are.
/// New ids: vertices: the old ones, then those on marked faces, in the order of these; cells: children in the order of their parents;
/// faces: the parts of the old ones in their order (of a half with the lower vertex first), then those inside cells. No communication.
Mesh bisect(const Mesh& whole, const std::vector<GlobalIndex>& marked, std::vector<std::uint8_t>& edge);

}  // namespace thixis::mesh
