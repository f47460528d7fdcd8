#include "thixis/mesh/ancestry.hpp"

#include <algorithm>
#include <numeric>

#include "cut.hpp"

namespace thixis::mesh {
namespace {

/// Writes the shapes of the children of a cut in a cell whose vertices are counted from vertex `first` on.
void add_shapes(const Cut& cut, int first, std::vector<Corners>& shapes) {
  for (int c = 0; c < cut.children; ++c) {
    Corners corners = {};
    for (int i = 0; i < 3; ++i) {
      const int point = cut.child[c][i];
      if (point < 3) {
        corners[i][(point + first) % 3] = 1;
      } else {
        for (const int end : {point + 1, point + 2}) corners[i][(end + first) % 3] = 0.5;
      }
    }
    shapes[cut.shape[c] + shapes_per_edge * first] = corners;
  }
}

std::vector<Corners> all_shapes() {
  std::vector<Corners> shapes(5 + 3 * shapes_per_edge);
  shapes[0] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  add_shapes(red, 0, shapes);
  for (int edge = 0; edge < 3; ++edge)
    for (const Cut& cut : bisections) add_shapes(cut, edge, shapes);
  return shapes;
}

/// All cells of a level that a uniform refinement made, in the order of their ids.
Ancestry::Level whole_uniform_level(GlobalIndex cells, Refinement refinement) {
  const Cut& cut = refinement == Refinement::red ? red : bisections[3];
  Ancestry::Level level;
  level.parent.resize(cells);
  level.shape.resize(cells);
  for (LocalIndex K = 0; K < cells; ++K) {
    level.parent[K] = K / 4;
    level.shape[K] = cut.shape[K % 4];
  }
  return level;
}

/// The owned cells of a level whose parents are owned cells of the next coarser one.
Ancestry::Level owned_level(const Mesh& mesh) {
  return {{mesh.cell_parent.begin(), mesh.cell_parent.begin() + mesh.owned_cells},
          {mesh.cell_shape.begin(), mesh.cell_shape.begin() + mesh.owned_cells}};
}

/// The same for parents listed in the order of all ids.
Ancestry::Level owned_level_of_ids(const Mesh& mesh) {
  return {{mesh.cell_parent_id.begin(), mesh.cell_parent_id.begin() + mesh.owned_cells},
          {mesh.cell_shape.begin(), mesh.cell_shape.begin() + mesh.owned_cells}};
}

}  // namespace

const std::vector<Corners>& child_shapes() {
  static const std::vector<Corners> shapes = all_shapes();
  return shapes;
}

Ancestry ancestry(const Hierarchy& hierarchy, int level) {
  const Mesh& finest = hierarchy.levels[level];
  Ancestry lineage;
  lineage.root = hierarchy.root;
  lineage.shared = finest.comm.size() == 1 ? 0 : std::min(hierarchy.partitioned, level);
  for (int j = 1; j <= level; ++j) {
    const Mesh& mesh = hierarchy.levels[j];
    lineage.levels.push_back(j <= lineage.shared       ? whole_uniform_level(mesh.global_cells, hierarchy.levels[j - 1].refinement)
                             : j == lineage.shared + 1 ? owned_level_of_ids(mesh)
                                                       : owned_level(mesh));
  }
  if (level <= lineage.shared) {
    lineage.leaf.assign(finest.cell_id.begin(), finest.cell_id.begin() + finest.owned_cells);
  } else {
    lineage.leaf.resize(finest.owned_cells);
    std::iota(lineage.leaf.begin(), lineage.leaf.end(), 0);
  }
  return lineage;
}

}  // namespace thixis::mesh
