#include "thixis/mesh/ancestry.hpp"
namespace thixis::mesh {
const std::vector<Corners>& child_shapes() {
  static const std::vector<Corners> shapes = [] {
    const std::array<double, 3> pt[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}};
    const int ch[9][3] = {{0, 1, 2}, {0, 5, 4}, {5, 1, 3}, {4, 3, 2}, {3, 4, 5}, {5, 3, 0}, {5, 1, 3}, {4, 3, 2}, {4, 0, 3}};
    std::vector<Corners> all;
    for (auto& c : ch) all.push_back({pt[c[0]], pt[c[1]], pt[c[2]]});
    return all;
  }();
  return shapes;
}
Ancestry ancestry(const Hierarchy& h, int level) {
  Ancestry a;
  a.root = std::shared_ptr<const Mesh>(&h.levels[0], [](const Mesh*) {});
  for (int j = 1; j <= level; ++j) {
    Ancestry::Level l;
    l.parent = h.levels[j].cell_parent;
    for (std::size_t K = 0; K < l.parent.size(); ++K) l.shape.push_back((h.levels[j].refinement == Refinement::red ? 1 : 5) + K % 4);
    a.levels.push_back(l);
  }
  for (LocalIndex K = 0; K < h.levels[level].owned_cells; ++K) a.leaf.push_back(K);
  return a;
}
}  // namespace thixis::mesh
