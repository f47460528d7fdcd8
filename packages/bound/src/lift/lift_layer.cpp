#include "lift/lift_layer.hpp"

#include "data/on_host.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::bound {
namespace {

constexpr int rows = 3;  ///< each step inwards costs and gains less

}  // namespace

std::vector<LocalIndex> lift_layer(const method::Space& space, const std::vector<bool>& dirichlet) {
  const mesh::Mesh& mesh = space.mesh();
  const auto host = mesh::on_host(mesh);
  const auto held = method::held_vertices(mesh, dirichlet);
  const auto cells = on_host(space.cells());
  std::vector<GlobalIndex> ids;
  for (std::size_t k = 0; k < cells.extent(0); ++k) ids.push_back(mesh.cell_id[cells(k)]);
  const auto own = algebra::map_of({ids.begin(), ids.begin() + mesh.owned_cells}, mesh.comm);
  const auto all = algebra::map_of(ids, mesh.comm);
  const algebra::Import import(own, all);
  algebra::Vector touches(own), touches_all(all);
  std::vector<bool> reached(mesh.vertices);
  for (LocalIndex v = 0; v < mesh.vertices; ++v) reached[v] = held[v] >= 0;
  for (int row = 0; row < rows; ++row) {
    {
      const auto out = algebra::host_overwrite(touches);
      for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
        out(K) = 0;
        for (int i = 0; i < 3; ++i)
          if (reached[host.cell_vertices(K, i)]) out(K) = 1;
      }
    }
    touches_all.doImport(touches, import, Tpetra::INSERT);
    const auto in = algebra::host_view(std::as_const(touches_all));
    for (std::size_t k = 0; k < cells.extent(0); ++k)
      for (int i = 0; i < 3 && in(k) != 0; ++i) reached[host.cell_vertices(cells(k), i)] = true;
  }
  const auto in = algebra::host_view(std::as_const(touches_all));
  std::vector<LocalIndex> layer;
  for (std::size_t k = 0; k < cells.extent(0); ++k)
    if (in(k) != 0) layer.push_back(static_cast<LocalIndex>(k));
  return layer;
}

}  // namespace thixis::bound
