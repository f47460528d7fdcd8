#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// How a child lies in its parent: an index into child_shapes().
using ChildShape = std::uint8_t;

/// Barycentric coordinates, in the parent, of the vertices of a child.
using Corners = std::array<std::array<double, 3>, 3>;

/// Every way in which a refinement cuts a child out of its parent: whole (0: the cell stays as it is), the four of the red refinement, and
/// those of one or two newest-vertex bisections.
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
