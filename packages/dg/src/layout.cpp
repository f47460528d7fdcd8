#include "layout.hpp"

#include <algorithm>
#include <vector>

#include "thixis/dg/params.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::dg {
namespace {

using Indices = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>;

std::vector<LocalIndex> faces_of_owned_cells(const mesh::Mesh& mesh, const mesh::HostMesh& host, const method::SpaceOptions& options) {
  std::vector<LocalIndex> faces;
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    if (std::any_of(&host.face_cells(F, 0), &host.face_cells(F, 0) + 2, [&](LocalIndex K) { return K >= 0 && K < mesh.owned_cells; }))
      faces.push_back(F);
  std::stable_sort(faces.begin(), faces.end(),
                   [&](LocalIndex F, LocalIndex G) { return role(host.face_tag(F), options) < role(host.face_tag(G), options); });
  return faces;
}

}  // namespace

bool strong(const method::SpaceOptions& options) { return options.params.own.get<Params>().boundary == BoundaryTreatment::strong; }

FaceRole role(LocalIndex tag, const method::SpaceOptions& options) {
  if (tag < 0) return FaceRole::form;
  if (!options.dirichlet[tag]) return FaceRole::free;
  return strong(options) ? FaceRole::held : FaceRole::form;
}

method::Structure layout(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const auto host = mesh::on_host(mesh);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), method::patch_cells(mesh));
  const reference::CellBasis basis(options.params.degree, method::family(options.params.nodes));
  const int n = basis.size();
  const std::vector<bool> fixing = strong(options) ? options.dirichlet : std::vector<bool>(options.dirichlet.size(), false);
  const auto vertex_tag = method::held_vertices(mesh, fixing), face_tag = method::held_faces(mesh, fixing);

  method::Structure s;
  s.element_entries = Indices("thixis::dg::element_entries", cells.extent(0), n);
  const auto entries = Kokkos::create_mirror_view(s.element_entries);
  std::vector<LocalIndex> position(mesh.cells, -1);
  s.entries.reserve(cells.extent(0) * n);
  for (std::size_t k = 0; k < cells.extent(0); ++k) {
    const LocalIndex K = cells(k);
    position[K] = static_cast<LocalIndex>(k);
    for (int i = 0; i < n; ++i) {
      const auto& entity = basis.entities()[i];
      const LocalIndex held = entity.kind == reference::Entity::vertex ? vertex_tag[host.cell_vertices(K, entity.index)]
                              : entity.kind == reference::Entity::face ? face_tag[host.cell_faces(K, entity.index)]
                                                                       : -1;
      const double xi = basis.points()[2 * i], eta = basis.points()[2 * i + 1], lambda[3] = {1 - xi - eta, xi, eta};
      std::array<double, 2> point = {0, 0};
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) point[d] += lambda[a] * host.coordinates(host.cell_vertices(K, a), d);
      entries(k, i) = s.entries.size();
      s.entries.add(n * mesh.cell_id[K] + i, mesh.cell_owner[K], held, point);
    }
  }
  Kokkos::deep_copy(s.element_entries, entries);

  const auto faces = faces_of_owned_cells(mesh, host, options);
  s.coupled_faces = method::View<LocalIndex*>("thixis::dg::coupled_faces", faces.size());
  s.coupled_entries = Indices("thixis::dg::coupled_entries", faces.size(), 2 * n);
  const auto coupled_faces = Kokkos::create_mirror_view(s.coupled_faces);
  const auto coupled = Kokkos::create_mirror_view(s.coupled_entries);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    coupled_faces(k) = faces[k];
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i) {
        const LocalIndex K = host.face_cells(faces[k], side);
        coupled(k, side * n + i) = K < 0 ? -1 : entries(position[K], i);
      }
  }
  Kokkos::deep_copy(s.coupled_faces, coupled_faces);
  Kokkos::deep_copy(s.coupled_entries, coupled);
  s.cell_entries = s.entries.size();
  s.global_cell_entries = n * mesh.global_cells;
  return s;
}

}  // namespace thixis::dg
