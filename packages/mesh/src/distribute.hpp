#pragma once
#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// Shares the cells of a mesh that every rank holds whole out to the ranks of a communicator, such that parts are of nearly equal weight
/// and have short common boundaries (METIS on the dual graph, by the root). `weight`: of each cell, empty: 1. One rank per cell, in the
/// order of local numbers. A rank may stay without cells, and does if there are fewer cells than ranks. Deterministic; collective.
std::vector<int> partition(const Mesh& whole, const core::Comm& comm, const std::vector<LocalIndex>& weight = {});

/// The same where the cells have owners already: these as they are while no rank has more than 1.05 times its share of the weight; else a
/// new partition whose parts go to the ranks that hold most of them.
std::vector<int> repartition(const Mesh& whole, const core::Comm& comm, const std::vector<LocalIndex>& weight,
                             const std::vector<int>& owner);

/// Writes the owners of the cells of a whole mesh, and those of its vertices and faces: the lowest rank among those of the cells around.
void set_owners(std::vector<int> cell_owner, Mesh& mesh);

/// The part of a whole mesh made of the cells `kept`, in that order, the first `owned` of them owned; vertices and faces keep their order.
Mesh extract(const Mesh& whole, const std::vector<LocalIndex>& kept, LocalIndex owned);

/// Partitions the finest of levels that every rank holds whole, with equal local and global numbers: it is cut down to the owned cells
/// and the ghosts that Mesh promises. The coarser levels stay whole; there the owner of a cell is that of its first child.
/// The owner of vertices and faces is the lowest rank among those of the cells around them.
void distribute(Hierarchy& hierarchy);

}  // namespace thixis::mesh
