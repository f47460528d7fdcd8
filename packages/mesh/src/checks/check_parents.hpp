#pragma once
#include "checks/findings.hpp"
#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// What is wrong in the relation of a level to the next coarser one. Collective.
///
/// `uniform`: the parents of all cells are on this rank, children have the ids 4 id + c, and the cells around owned vertices all their
/// children. Otherwise the parents of this rank's cells may be anywhere.
void check_parents(const Mesh& coarse, const Mesh& fine, bool uniform, Findings& findings);

}  // namespace thixis::mesh
