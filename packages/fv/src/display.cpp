#include <algorithm>

#include "thixis/fv/host.hpp"

namespace thixis::fv {
namespace {

/// The lowest rank among those of the cells around each vertex that are here; that is, of all for vertices of owned cells.
std::vector<int> vertex_owners(const Grid& grid, const HostGrid& host) {
  std::vector<int> owner(grid.vertices, grid.comm.size());
  for (LocalIndex K = 0; K < grid.cells; ++K)
    for (int i = 0; i < grid.corners(); ++i) {
      int& lowest = owner[host.cell_vertices(K, i)];
      lowest = std::min(lowest, grid.cell_owner[K]);
    }
  return owner;
}

}  // namespace

output::Grid display(const Grid& grid) {
  const HostGrid host = on_host(grid);
  output::Grid shown;
  shown.global_points = grid.global_vertices;
  shown.point_id = grid.vertex_id;
  shown.point_owner = vertex_owners(grid, host);
  for (LocalIndex v = 0; v < grid.vertices; ++v) shown.points.push_back({host.vertex(v, 0), host.vertex(v, 1)});

  const int corners = grid.corners();
  const std::vector<GlobalIndex> id(grid.cell_id.begin(), grid.cell_id.begin() + grid.owned_cells);
  const std::vector<int> owner(grid.owned_cells, grid.comm.rank());
  if (corners == 3) {
    shown.global_triangles = grid.global_cells;
    shown.triangle_id = id;
    shown.triangle_owner = owner;
    for (LocalIndex K = 0; K < grid.owned_cells; ++K)
      shown.triangles.push_back({host.cell_vertices(K, 0), host.cell_vertices(K, 1), host.cell_vertices(K, 2)});
    return shown;
  }
  shown.others = {corners, grid.global_cells, {}, id, owner};
  for (LocalIndex K = 0; K < grid.owned_cells; ++K)
    for (int i = 0; i < corners; ++i) shown.others.points.push_back(host.cell_vertices(K, i));
  return shown;
}

}  // namespace thixis::fv
