#include "checks/check_parents.hpp"

#include <cmath>

#include "thixis/mesh/ancestry.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::mesh {
namespace {

/// A level and the next coarser one, readable.
struct Pair {
  const Mesh &coarse, &fine;
  HostMesh above, host;
  bool uniform;
};

bool wrong_parent(const Pair& at, LocalIndex K) {
  const LocalIndex parent = at.fine.cell_parent[K];
  const GlobalIndex id = at.fine.cell_parent_id[K];
  if (at.uniform && id != at.fine.cell_id[K] / 4) return true;
  if (parent == -1) return at.uniform || !inside(id, at.coarse.global_cells);
  return !inside(parent, at.coarse.cells) || at.coarse.cell_id[parent] != id;
}

/// Uniform levels: the four children of the cells on this rank.
void check_children(const Pair& at, Findings& findings) {
  const auto area = [&](LocalIndex K) { return cell_area(at.above.parameter, at.above.cell_vertices, K); };
  std::vector<int> children(at.coarse.cells, 0);
  std::vector<double> rest(at.coarse.cells);
  for (LocalIndex K = 0; K < at.coarse.cells; ++K) rest[K] = area(K);
  for (LocalIndex K = 0; K < at.fine.cells; ++K) {
    const LocalIndex parent = at.fine.cell_parent[K];
    if (wrong_parent(at, K)) continue;
    ++children[parent];
    rest[parent] -= cell_area(at.host.parameter, at.host.cell_vertices, K);
  }
  findings.count("parents that their children do not fill", at.coarse.cells, [&](LocalIndex K) {
    if (children[K] == 0) return false;  // a cell of a level held whole, far from this rank
    return children[K] != 4 || !(std::abs(rest[K]) <= 1e-12 * area(K));
  });
  std::vector<bool> owned(at.coarse.vertices);
  for (LocalIndex v = 0; v < at.coarse.vertices; ++v) owned[v] = at.coarse.vertex_owner[v] == at.coarse.comm.rank();
  findings.count("cells around owned vertices that lack children", at.coarse.cells, [&](LocalIndex K) {
    const auto vertices = Kokkos::subview(at.above.cell_vertices, K, Kokkos::ALL);
    return (owned[vertices(0)] || owned[vertices(1)] || owned[vertices(2)]) && children[K] != 4;
  });
}

/// Adaptive levels: the areas of parents and children, wherever they are.
void check_areas(const Pair& at, Findings& findings) {
  std::vector<double> area(at.coarse.global_cells, 0), rest(at.coarse.global_cells, 0);
  for (LocalIndex K = 0; K < at.coarse.owned_cells; ++K)
    rest[at.coarse.cell_id[K]] = area[at.coarse.cell_id[K]] = cell_area(at.above.parameter, at.above.cell_vertices, K);
  for (LocalIndex K = 0; K < at.fine.owned_cells; ++K)
    if (const GlobalIndex id = at.fine.cell_parent_id[K]; inside(id, at.coarse.global_cells))
      rest[id] -= cell_area(at.host.parameter, at.host.cell_vertices, K);
  at.fine.comm.sum(area);
  at.fine.comm.sum(rest);
  findings.count("parents that their children do not fill", at.fine.comm.root() ? static_cast<LocalIndex>(area.size()) : 0,
                 [&](LocalIndex K) { return !(std::abs(rest[K]) <= 1e-12 * area[K]); });
}

void check_shapes(const Pair& at, Findings& findings) {
  findings.count("cells that lie in their parent in another way than their shape says", at.fine.cells, [&](LocalIndex K) {
    const LocalIndex parent = at.fine.cell_parent[K];
    if (at.fine.cell_shape[K] >= child_shapes().size()) return true;
    if (!inside(parent, at.coarse.cells)) return false;
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d) {
        double x = 0;
        for (int a = 0; a < 3; ++a)
          x += child_shapes()[at.fine.cell_shape[K]][i][a] * at.above.parameter(at.above.cell_vertices(parent, a), d);
        if (x != at.host.parameter(at.host.cell_vertices(K, i), d)) return true;
      }
    return false;
  });
}

void check_vertices(const Pair& at, Findings& findings) {
  findings.count("vertices that are not the midpoint of their parents", at.fine.vertices, [&](LocalIndex v) {
    const auto [a, b] = at.fine.vertex_parents[v];
    if (!at.uniform && a == -1 && b == -1) return false;
    if (!inside(a, at.coarse.vertices) || !inside(b, at.coarse.vertices)) return true;
    const GlobalIndex id = at.fine.vertex_id[v];
    if ((a == b) != (id < at.coarse.global_vertices) || (a == b && id != at.coarse.vertex_id[a])) return true;
    for (int d = 0; d < 2; ++d)
      if (at.host.parameter(v, d) != 0.5 * (at.above.parameter(a, d) + at.above.parameter(b, d))) return true;
    return false;
  });
}

}  // namespace

void check_parents(const Mesh& coarse, const Mesh& fine, bool uniform, Findings& findings) {
  const auto cells = static_cast<std::size_t>(fine.cells), vertices = static_cast<std::size_t>(fine.vertices);
  const bool sized = fine.cell_parent.size() == cells && fine.cell_parent_id.size() == cells && fine.cell_shape.size() == cells &&
                     fine.vertex_parents.size() == vertices;
  findings.add("ranks with parents of another number than cells or vertices", sized ? 0 : 1);
  if (fine.comm.any(!sized)) return;
  const Pair at = {coarse, fine, on_host(coarse), on_host(fine), uniform};
  findings.count("cells whose parent has another id", fine.cells, [&](LocalIndex K) { return wrong_parent(at, K); });
  if (uniform) check_children(at, findings);
  else check_areas(at, findings);
  check_shapes(at, findings);
  check_vertices(at, findings);
}

}  // namespace thixis::mesh
