#include "lagrange_nodes.hpp"

namespace thixis::fem {
namespace {

using reference::Entity;

class Nodes {
 public:
  Nodes(const mesh::Mesh& mesh, const method::SpaceOptions& options)
      : mesh_(mesh),
        host_(mesh::on_host(mesh)),
        basis_(options.params.degree, method::family(options.params.nodes)),
        on_face_(basis_.degree() - 1),
        vertex_tag_(method::held_vertices(mesh, options.dirichlet)),
        face_tag_(method::held_faces(mesh, options.dirichlet)),
        entry_of_vertex_(mesh.vertices, -1),
        first_entry_of_face_(mesh.faces, -1) {}

  method::Structure structure(bool condensed) {
    const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), method::patch_cells(mesh_));
    const int n = basis_.size();
    s_.element_entries = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>("thixis::fem::element_entries", cells.extent(0), n);
    const auto entries = Kokkos::create_mirror_view(s_.element_entries);
    s_.entries.reserve(cells.extent(0) * n / 2);
    for (std::size_t k = 0; k < cells.extent(0); ++k) {
      int of_face[3] = {}, inside = 0;  // functions seen so far
      for (int l = 0; l < n; ++l) {
        const auto& entity = basis_.entities()[l];
        entries(k, l) = entity.kind == Entity::vertex ? vertex(cells(k), entity.index)
                        : entity.kind == Entity::face ? face(cells(k), entity.index, of_face[entity.index]++, l)
                                                      : interior(cells(k), inside++, l);
      }
    }
    Kokkos::deep_copy(s_.element_entries, entries);
    s_.cell_entries = s_.entries.size();
    s_.global_cell_entries = mesh_.global_vertices + on_face_ * mesh_.global_faces + basis_.interior() * mesh_.global_cells;
    s_.interior = condensed ? basis_.interior() : 0;
    return std::move(s_);
  }

 private:
  LocalIndex add(GlobalIndex id, int owner, LocalIndex held, std::array<double, 2> point) {
    s_.entries.add(id, owner, held, point);
    return s_.entries.size() - 1;
  }

  std::array<double, 2> place(LocalIndex K, int l) const {
    const double xi = basis_.points()[2 * l], eta = basis_.points()[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
    std::array<double, 2> point = {0, 0};
    for (int a = 0; a < 3; ++a)
      for (int d = 0; d < 2; ++d) point[d] += lambda[a] * host_.coordinates(host_.cell_vertices(K, a), d);
    return point;
  }

  LocalIndex vertex(LocalIndex K, int i) {
    const LocalIndex v = host_.cell_vertices(K, i);
    LocalIndex& entry = entry_of_vertex_[v];
    if (entry < 0)
      entry = add(mesh_.vertex_id[v], mesh_.vertex_owner[v], vertex_tag_[v], {host_.coordinates(v, 0), host_.coordinates(v, 1)});
    return entry;
  }

  /// The k-th node of the cell's face i, counted from vertex i+1 to i+2; the p-1 entries of a face run from its lower vertex id.
  LocalIndex face(LocalIndex K, int i, int k, int l) {
    const LocalIndex F = host_.cell_faces(K, i);
    const bool along = host_.face_vertices(F, 0) == host_.cell_vertices(K, (i + 1) % 3);
    LocalIndex& first = first_entry_of_face_[F];
    if (first < 0) {
      first = s_.entries.size();
      for (int j = 0; j < on_face_; ++j) {
        const int of_cell = l - k + (along ? j : on_face_ - 1 - j);
        add(mesh_.global_vertices + on_face_ * mesh_.face_id[F] + j, mesh_.face_owner[F], face_tag_[F], place(K, of_cell));
      }
    }
    return first + (along ? k : on_face_ - 1 - k);
  }

  LocalIndex interior(LocalIndex K, int k, int l) {
    return add(mesh_.global_vertices + on_face_ * mesh_.global_faces + basis_.interior() * mesh_.cell_id[K] + k, mesh_.cell_owner[K], -1,
               place(K, l));
  }

  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
  reference::CellBasis basis_;
  int on_face_;
  std::vector<LocalIndex> vertex_tag_, face_tag_, entry_of_vertex_, first_entry_of_face_;
  method::Structure s_;
};

}  // namespace

method::Structure lagrange_nodes(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  return Nodes(mesh, options).structure(options.params.condensed());
}

}  // namespace thixis::fem
