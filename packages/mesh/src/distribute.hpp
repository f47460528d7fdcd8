#pragma once
#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// Shares the cells of a mesh that every rank holds whole out to the ranks, such that parts are of nearly equal size and have short common
/// boundaries (METIS on the dual graph, by the root). One rank per cell, in the order of local numbers. A rank may stay without cells, and
/// does if there are fewer cells than ranks. Deterministic.
std::vector<int> partition(const Mesh& whole);

/// Partitions the finest of levels that every rank holds whole, with equal local and global numbers: it is cut down to the owned cells
/// and the ghosts that Mesh promises. The coarser levels stay whole; there the owner of a cell is that of its first child.
/// The owner of vertices and faces is the lowest rank among those of the cells around them.
void distribute(Hierarchy& hierarchy);

}  // namespace thixis::mesh
