#include "lagrange_nodes.hpp"

#include "thixis/method/continuous_nodes.hpp"

namespace thixis::fem {

method::Structure lagrange_nodes(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const reference::CellBasis basis(options.params.degree, method::family(options.params.nodes));
  auto nodes = method::continuous_nodes(mesh, method::patch_cells(mesh), basis, basis.points(), options.dirichlet);
  method::Structure s;
  s.entries = std::move(nodes.entries);
  s.element_entries = nodes.of_cells;
  s.cell_entries = s.entries.size();
  s.global_cell_entries = mesh.global_vertices + (basis.degree() - 1) * mesh.global_faces + basis.interior() * mesh.global_cells;
  s.interior = options.params.condensation.value_or(false) ? basis.interior() : 0;
  return s;
}

}  // namespace thixis::fem
