#include "thixis/method/continuous_nodes.hpp"

#include <array>

#include "thixis/mesh/host.hpp"
#include "thixis/method/layout.hpp"

namespace thixis::method {
namespace {

using reference::Entity;

class Builder {
 public:
  Builder(const mesh::Mesh& mesh, const reference::CellBasis& basis, const std::vector<double>& points, const std::vector<bool>& dirichlet)
      : mesh_(mesh),
        host_(mesh::on_host(mesh)),
        basis_(basis),
        points_(points),
        on_face_(basis.degree() - 1),
        vertex_tag_(held_vertices(mesh, dirichlet)),
        face_tag_(held_faces(mesh, dirichlet)),
        entry_of_vertex_(mesh.vertices, -1),
        first_of_face_(mesh.faces, -1) {}

  ContinuousNodes build(const View<const LocalIndex*>& cells) {
    const int n = basis_.size();
    nodes_.of_cells = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>("thixis::method::continuous_nodes", cells.extent(0), n);
    const auto out = Kokkos::create_mirror_view(nodes_.of_cells);
    const auto K = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells);
    for (std::size_t k = 0; k < cells.extent(0); ++k) {
      int of_face[3] = {}, inside = 0;
      for (int l = 0; l < n; ++l) {
        const auto& entity = basis_.entities()[l];
        out(k, l) = entity.kind == Entity::vertex ? vertex(K(k), entity.index)
                    : entity.kind == Entity::face ? face(K(k), entity.index, of_face[entity.index]++, l)
                                                  : interior(K(k), inside++, l);
      }
    }
    Kokkos::deep_copy(nodes_.of_cells, out);
    return std::move(nodes_);
  }

 private:
  LocalIndex add(GlobalIndex id, int owner, LocalIndex held, std::array<double, 2> point) {
    nodes_.entries.add(id, owner, held, point);
    return nodes_.entries.size() - 1;
  }
  std::array<double, 2> place(LocalIndex K, int l) const {
    const double xi = points_[2 * l], eta = points_[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
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
  /// The k-th node of the cell's face i, counted from vertex i+1 to i+2.
  LocalIndex face(LocalIndex K, int i, int k, int l) {
    const LocalIndex F = host_.cell_faces(K, i);
    const bool along = host_.face_vertices(F, 0) == host_.cell_vertices(K, (i + 1) % 3);
    LocalIndex& first = first_of_face_[F];
    if (first < 0) {
      first = nodes_.entries.size();
      for (int j = 0; j < on_face_; ++j)
        add(mesh_.global_vertices + on_face_ * mesh_.face_id[F] + j, mesh_.face_owner[F], face_tag_[F],
            place(K, l - k + (along ? j : on_face_ - 1 - j)));
    }
    return first + (along ? k : on_face_ - 1 - k);
  }
  LocalIndex interior(LocalIndex K, int k, int l) {
    return add(mesh_.global_vertices + on_face_ * mesh_.global_faces + basis_.interior() * mesh_.cell_id[K] + k, mesh_.cell_owner[K], -1,
               place(K, l));
  }

  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
  const reference::CellBasis& basis_;
  const std::vector<double>& points_;
  int on_face_;
  std::vector<LocalIndex> vertex_tag_, face_tag_, entry_of_vertex_, first_of_face_;
  ContinuousNodes nodes_;
};

}  // namespace

ContinuousNodes continuous_nodes(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const reference::CellBasis& basis,
                                 const std::vector<double>& points, const std::vector<bool>& dirichlet) {
  return Builder(mesh, basis, points, dirichlet).build(cells);
}

}  // namespace thixis::method
