#include "thixis/mesh/ancestry.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "refinement/adaptive.hpp"
#include "refinement/cut.hpp"

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

/// How cell `id` of a level that a uniform refinement made lies in its parent.
ChildShape uniform_shape(GlobalIndex id, Refinement refinement) {
  return (refinement == Refinement::red ? red : bisections[3]).shape[id % 4];
}

/// All cells of such a level, in the order of their ids.
Ancestry::Level whole_uniform_level(GlobalIndex cells, Refinement refinement) {
  Ancestry::Level level;
  level.parent.resize(cells);
  level.shape.resize(cells);
  for (LocalIndex K = 0; K < cells; ++K) {
    level.parent[K] = K / 4;
    level.shape[K] = uniform_shape(K, refinement);
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

/// The levels beyond the partitioned one above an adaptive level: what this rank's trees under the partition of that level hold of them, in
/// the order of ids.
std::vector<Ancestry::Level> levels_of_trees(const Hierarchy& hierarchy, int level) {
  const Adaptive& state = *hierarchy.adaptive;
  const std::vector<int>& owner = state.steps[level - state.uniform_levels]->tree_owner;
  std::vector<LocalIndex> position(owner.size(), -1);  // in its list, of each cell by its id; -1: of another rank
  for (std::size_t tree = 0; tree < owner.size(); ++tree)
    if (owner[tree] == hierarchy.finest().comm.rank()) position[tree] = static_cast<LocalIndex>(tree);

  std::vector<Ancestry::Level> lists;
  for (int j = hierarchy.partitioned + 1; j <= level; ++j) {
    const Adaptive::Step* step = j < state.uniform_levels ? nullptr : state.steps[j - state.uniform_levels].get();
    const auto cells = static_cast<LocalIndex>(hierarchy.levels[j].global_cells);
    const Refinement refinement = hierarchy.levels[j - 1].refinement;
    std::vector<LocalIndex> finer(cells, -1);
    Ancestry::Level list;
    for (LocalIndex K = 0; K < cells; ++K) {
      const LocalIndex parent = position[step ? step->parent[K] : K / 4];
      if (parent < 0) continue;
      finer[K] = static_cast<LocalIndex>(list.parent.size());
      list.parent.push_back(parent);
      list.shape.push_back(step ? step->shape[K] : uniform_shape(K, refinement));
    }
    position = std::move(finer);
    lists.push_back(std::move(list));
  }
  return lists;
}

/// The same above a uniform level, or on one rank: from the levels themselves.
std::vector<Ancestry::Level> levels_beyond(const Hierarchy& hierarchy, int shared, int level) {
  std::vector<Ancestry::Level> lists;
  for (int j = shared + 1; j <= level; ++j)
    lists.push_back(j == shared + 1 ? owned_level_of_ids(hierarchy.levels[j]) : owned_level(hierarchy.levels[j]));
  return lists;
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
  for (int j = 1; j <= lineage.shared; ++j)
    lineage.levels.push_back(whole_uniform_level(hierarchy.levels[j].global_cells, hierarchy.levels[j - 1].refinement));
  const bool moved = finest.comm.size() > 1 && hierarchy.adaptive && level >= hierarchy.adaptive->uniform_levels;
  auto beyond = moved ? levels_of_trees(hierarchy, level) : levels_beyond(hierarchy, lineage.shared, level);
  std::move(beyond.begin(), beyond.end(), std::back_inserter(lineage.levels));
  if (level <= lineage.shared) {
    lineage.leaf.assign(finest.cell_id.begin(), finest.cell_id.begin() + finest.owned_cells);
  } else {
    lineage.leaf.resize(finest.owned_cells);
    std::iota(lineage.leaf.begin(), lineage.leaf.end(), 0);
  }
  return lineage;
}

}  // namespace thixis::mesh
