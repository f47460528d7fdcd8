#pragma once
#include <array>
#include <memory>
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// Barycentric coordinates, in the parent, of the vertices of a child.
using Corners = std::array<std::array<double, 3>, 3>;

/// Every way in which a refinement cuts a child out of its parent, by ChildShape:
///   0           whole: the cell stays as it is;
///   1 + c       child c of the red refinement;
///   5 + 6e + b  newest-vertex bisections of a cell with the refinement edge e, in its vertices (v0, v1, v2) counted from vertex e on, with
///               M, P, Q the midpoints of the faces opposite v0, v2, v1: once (M, v0, v1), (M, v2, v0), and twice (P, M, v0), (P, v1, M),
///               (Q, M, v2), (Q, v0, M).
const std::vector<Corners>& child_shapes();

/// The ancestors of the cells that this rank owns on one level of a hierarchy, down to the coarsest mesh: what is summed up over children
/// and handed down to them.
///
/// Level j is a list of cells. Up to level `shared` the lists hold all cells of the level, in the order of their global ids, the same on
/// all ranks: sums over children that lie on several ranks are to be reduced there. Beyond it they hold this rank's cells only,
/// with all their children.
struct Ancestry {
  struct Level {
    std::vector<LocalIndex> parent;  ///< index in the list of the level before
    std::vector<ChildShape> shape;
  };
  std::shared_ptr<const Mesh> root;  ///< level 0, whole on every rank, alone on its communicator; its cells are list 0, in this order
  std::vector<Level> levels;         ///< levels 1, 2, …
  int shared = 0;
  std::vector<LocalIndex> leaf;  ///< of each owned cell of the finest level: index in the last list
};

/// Of level `level` of the hierarchy. Collective.
Ancestry ancestry(const Hierarchy& hierarchy, int level);

}  // namespace thixis::mesh
