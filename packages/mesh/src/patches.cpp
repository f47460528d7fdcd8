#include "patches.hpp"

#include <numeric>

namespace thixis::mesh {

std::vector<LocalIndex> cells_touching(const Mesh& mesh, const std::vector<LocalIndex>& cells, const std::vector<LocalIndex>& candidates) {
  const auto cell_vertices = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mesh.cell_vertices);
  std::vector<bool> touched(mesh.vertices, false);
  for (const LocalIndex K : cells)
    for (int i = 0; i < 3; ++i) touched[cell_vertices(K, i)] = true;
  std::vector<LocalIndex> touching;
  for (const LocalIndex K : candidates)
    if (touched[cell_vertices(K, 0)] || touched[cell_vertices(K, 1)] || touched[cell_vertices(K, 2)]) touching.push_back(K);
  return touching;
}

void find_ghost_patch_cells(Mesh& mesh) {
  std::vector<LocalIndex> ghosts;
  if (mesh.owned_cells < mesh.cells) {
    std::vector<LocalIndex> owned(mesh.owned_cells), others(mesh.cells - mesh.owned_cells);
    std::iota(owned.begin(), owned.end(), 0);
    std::iota(others.begin(), others.end(), mesh.owned_cells);
    ghosts = cells_touching(mesh, owned, others);
  }
  mesh.ghost_patch_cells =
      View<LocalIndex*>(Kokkos::view_alloc(Kokkos::WithoutInitializing, "thixis::mesh::ghost_patch_cells"), ghosts.size());
  const auto host = Kokkos::create_mirror_view(mesh.ghost_patch_cells);
  for (std::size_t k = 0; k < ghosts.size(); ++k) host(k) = ghosts[k];
  Kokkos::deep_copy(mesh.ghost_patch_cells, host);
}

}  // namespace thixis::mesh
