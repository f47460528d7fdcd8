#pragma once
#include <string>
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// What is inconsistent in a level: a sentence with a count each; empty if it keeps all promises of Mesh. The same on all ranks;
/// collective.
///
/// Sizes and index ranges; positive areas; faces opposite their vertices, from low to high id, with their cells in the right slots; the
/// boundary tagged, whole patches around vertices of owned cells and owned vertices; ghost_patch_cells; each id 0..global-1 owned by
/// exactly one rank, and owners known alike by all.
std::vector<std::string> check(const Mesh& mesh);

/// The same for all levels, and for the relation between them: children fill their parents (in the parameter domain), new vertices are
/// midpoints.
std::vector<std::string> check(const Hierarchy& hierarchy);

}  // namespace thixis::mesh
