#pragma once
#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// Those of `candidates` that share a vertex with one of `cells`.
std::vector<LocalIndex> cells_touching(const Mesh& mesh, const std::vector<LocalIndex>& cells, const std::vector<LocalIndex>& candidates);

/// Fills ghost_patch_cells of a mesh that is complete otherwise.
void find_ghost_patch_cells(Mesh& mesh);

}  // namespace thixis::mesh
