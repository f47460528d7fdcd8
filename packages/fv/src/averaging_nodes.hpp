#pragma once
#include <array>
#include <string>
#include <vector>

#include "thixis/fv/grid.hpp"

namespace thixis::fv {

/// Lists of equal meaning one after the other: entries begin(i), ..., begin(i + 1) - 1 belong to i.
struct Lists {
  View<LocalIndex*> begin, entry;
};

/// Where averages are taken, in the numbering of this rank: the vertices, and in the plane the midpoints of faces.
struct AveragingNodes {
  std::vector<GlobalIndex> ids;  ///< on all ranks: vertices, then faces
  View<double* [2]> position;
  Lists cells, held;                         ///< owned cells and held faces around each node
  View<LocalIndex**> corners;                ///< of the owned cells
  View<LocalIndex*> face_node;               ///< -1 in one dimension, where a face is a vertex
  std::vector<std::array<double, 2>> count;  ///< cells and held faces around each node on this rank
};

/// `held`: by face.
AveragingNodes averaging_nodes(const Grid& grid, const std::vector<bool>& held);

}  // namespace thixis::fv
