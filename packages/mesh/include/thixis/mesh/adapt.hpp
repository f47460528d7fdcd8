#pragma once
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// Appends a level to the hierarchy: the marked cells of its finest one are cut by newest-vertex bisection, and as many others as keep the
/// mesh conforming. `marked`: owned cells (local numbers) of this rank. New vertices lie where the chart puts them.
///
/// Global ids do not depend on the number of ranks. The cells are shared out anew: whole trees above the cells of the level that was
/// partitioned first move between ranks (METIS, weights = leaves). References to the meshes of the hierarchy stay valid.
/// Collective; throws InputError where the mesh would grow beyond what local numbers hold.
void adapt(Hierarchy& hierarchy, const std::vector<LocalIndex>& marked);

}  // namespace thixis::mesh
