#include "layout.hpp"

#include "thixis/mesh/geometry.hpp"

namespace thixis::hho {

method::Structure layout(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const reference::CellBasis basis(options.params.degree, method::family(options.params.nodes));
  const auto host = mesh::on_host(mesh);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), method::patch_cells(mesh));
  const auto tag = method::held_faces(mesh, options.dirichlet);
  const int n = basis.size(), p = basis.degree(), count = cells.extent_int(0);

  method::Structure s;
  s.element_entries = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>("thixis::hho::element_entries", count, n + 3 * p);
  const auto entries = Kokkos::create_mirror_view(s.element_entries);
  s.entries.reserve(static_cast<std::size_t>(count) * (n + 2 * p));
  for (int k = 0; k < count; ++k) {
    const LocalIndex K = cells(k);
    for (int i = 0; i < n; ++i) {
      const double xi = basis.points()[2 * i], eta = basis.points()[2 * i + 1], lambda[3] = {1 - xi - eta, xi, eta};
      std::array<double, 2> place = {0, 0};
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) place[d] += lambda[a] * host.coordinates(host.cell_vertices(K, a), d);
      entries(k, i) = s.entries.size();
      s.entries.add(n * mesh.cell_id[K] + i, mesh.cell_owner[K], -1, place);
    }
  }
  s.cell_entries = s.entries.size();
  s.global_cell_entries = n * mesh.global_cells;
  s.interior = options.params.condensation.value_or(true) ? n : 0;

  std::vector<LocalIndex> first_of_face(mesh.faces, -1);
  for (int k = 0; k < count; ++k)
    for (int f = 0; f < 3; ++f) {
      const LocalIndex F = host.cell_faces(cells(k), f);
      if (first_of_face[F] < 0) {
        first_of_face[F] = s.entries.size();
        const mesh::FaceGeometry geometry = mesh::face_geometry(host.coordinates, host.face_vertices, F);
        for (int j = 0; j < p; ++j)
          s.entries.add(s.global_cell_entries + p * mesh.face_id[F] + j, mesh.face_owner[F], tag[F],
                        {geometry.midpoint[0], geometry.midpoint[1]});
      }
      for (int j = 0; j < p; ++j) entries(k, n + f * p + j) = first_of_face[F] + j;
    }
  Kokkos::deep_copy(s.element_entries, entries);
  return s;
}

}  // namespace thixis::hho
