#include <algorithm>
#include <cmath>
#include <numeric>

#include "grids.hpp"
#include "thixis/fv/host.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::fv {
namespace {

/// Entities of a mesh that a grid keeps, in the order of the grid, and their places in it.
struct Kept {
  std::vector<LocalIndex> entities;
  std::vector<LocalIndex> place;  ///< of all entities of the mesh; -1: not kept

  explicit Kept(LocalIndex all) : place(all, -1) {}
  void add(LocalIndex entity) {
    if (place[entity] >= 0) return;
    place[entity] = size();
    entities.push_back(entity);
  }
  /// Sorts those from `begin` on by their ids.
  void sort(const std::vector<GlobalIndex>& id, LocalIndex begin = 0) {
    std::sort(entities.begin() + begin, entities.end(), [&](LocalIndex i, LocalIndex j) { return id[i] < id[j]; });
    for (LocalIndex k = begin; k < size(); ++k) place[entities[k]] = k;
  }
  LocalIndex size() const { return static_cast<LocalIndex>(entities.size()); }
  std::vector<GlobalIndex> ids(const std::vector<GlobalIndex>& id) const {
    std::vector<GlobalIndex> result(entities.size());
    std::transform(entities.begin(), entities.end(), result.begin(), [&](LocalIndex i) { return id[i]; });
    return result;
  }
};

struct Builder {
  const mesh::Mesh& mesh;
  mesh::HostMesh from;
  Kept cells, faces, vertices;
  Grid grid;
  HostGrid host;

  explicit Builder(const mesh::Mesh& finest)
      : mesh(finest), from(mesh::on_host(finest)), cells(finest.cells), faces(finest.faces), vertices(finest.vertices) {
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
      cells.add(K);
      for (int i = 0; i < 3; ++i) faces.add(from.cell_faces(K, i));
    }
    cells.sort(mesh.cell_id);
    const auto ghosts = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mesh.ghost_patch_cells);
    for (std::size_t k = 0; k < ghosts.extent(0); ++k) cells.add(ghosts(k));
    cells.sort(mesh.cell_id, mesh.owned_cells);
    for (const LocalIndex K : cells.entities)
      for (int i = 0; i < 3; ++i) vertices.add(from.cell_vertices(K, i));
    faces.sort(mesh.face_id);
    vertices.sort(mesh.vertex_id);
  }

  void allocate_all() {
    grid.comm = mesh.comm;
    grid.global_cells = mesh.global_cells;
    grid.global_faces = mesh.global_faces;
    grid.global_vertices = mesh.global_vertices;
    grid.owned_cells = mesh.owned_cells;
    grid.cells = cells.size();
    grid.faces = faces.size();
    grid.vertices = vertices.size();
    grid.tags = mesh.tags;
    host = allocate(grid, 3);
    grid.cell_id = cells.ids(mesh.cell_id);
    grid.face_id = faces.ids(mesh.face_id);
    grid.vertex_id = vertices.ids(mesh.vertex_id);
  }

  void add_cell(LocalIndex K) {
    const LocalIndex of_mesh = cells.entities[K];
    grid.cell_owner[K] = mesh.cell_owner[of_mesh];
    double x[3][2];
    for (int i = 0; i < 3; ++i) {
      const LocalIndex a = from.cell_vertices(of_mesh, i);
      host.cell_vertices(K, i) = vertices.place[a];
      for (int d = 0; d < 2; ++d) x[i][d] = from.coordinates(a, d);
    }
    // Circumcentre x_0 + c with c·u = |u|²/2, c·v = |v|²/2 for the edges u, v from x_0.
    const double u[2] = {x[1][0] - x[0][0], x[1][1] - x[0][1]}, v[2] = {x[2][0] - x[0][0], x[2][1] - x[0][1]};
    const double twice = u[0] * v[1] - u[1] * v[0], uu = u[0] * u[0] + u[1] * u[1], vv = v[0] * v[0] + v[1] * v[1];
    host.centre(K, 0) = x[0][0] + (v[1] * uu - u[1] * vv) / (2 * twice);
    host.centre(K, 1) = x[0][1] + (u[0] * vv - v[0] * uu) / (2 * twice);
    for (int d = 0; d < 2; ++d) host.barycentre(K, d) = (x[0][d] + x[1][d] + x[2][d]) / 3;
    host.volume(K) = twice / 2;
    host.diameter(K) = std::max({std::sqrt(uu), std::sqrt(vv), std::hypot(u[0] - v[0], u[1] - v[1])});
  }

  void add_face(LocalIndex F) {
    const LocalIndex of_mesh = faces.entities[F];
    LocalIndex first = mesh::first_cell(from.face_cells, of_mesh);
    LocalIndex second = mesh::neighbour(from.face_cells, of_mesh, first);
    if (second >= 0 && mesh.cell_id[second] < mesh.cell_id[first]) std::swap(first, second);
    const auto face = mesh::face_geometry(from.coordinates, from.face_vertices, of_mesh);
    const int sign = mesh::normal_sign(from.face_cells, of_mesh, first);
    const LocalIndex K = host.face_cells(F, 0) = cells.place[first];
    const LocalIndex L = host.face_cells(F, 1) = second < 0 ? -1 : cells.place[second];
    host.face_area(F) = face.length;
    host.face_tag(F) = from.face_tag(of_mesh);
    double distance = 0;
    for (int d = 0; d < 2; ++d) {
      host.face_centre(F, d) = face.midpoint[d];
      host.face_normal(F, d) = sign * face.normal[d];
      distance += ((L < 0 ? face.midpoint[d] : host.centre(L, d)) - host.centre(K, d)) * host.face_normal(F, d);
    }
    host.face_distance(F) = distance;
  }

  void add_faces_of_cell(LocalIndex K) {
    LocalIndex of_cell[3];
    for (int i = 0; i < 3; ++i) of_cell[i] = faces.place[from.cell_faces(cells.entities[K], i)];
    std::sort(of_cell, of_cell + 3);
    for (int i = 0; i < 3; ++i) host.cell_faces(3 * K + i) = of_cell[i];
  }

  void add_vertex(LocalIndex v) {
    for (int d = 0; d < 2; ++d) host.vertex(v, d) = from.coordinates(vertices.entities[v], d);
  }
};

}  // namespace

Grid triangle_grid(const mesh::Mesh& mesh) {
  Builder builder(mesh);
  builder.allocate_all();
  for (LocalIndex K = 0; K < builder.grid.cells; ++K) builder.add_cell(K);
  for (LocalIndex F = 0; F < builder.grid.faces; ++F) builder.add_face(F);
  for (LocalIndex K = 0; K < builder.grid.owned_cells; ++K) builder.add_faces_of_cell(K);
  for (LocalIndex v = 0; v < builder.grid.vertices; ++v) builder.add_vertex(v);
  commit(builder.host, builder.grid);
  return builder.grid;
}

}  // namespace thixis::fv
