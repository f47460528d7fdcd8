#include "thixis/mesh/host.hpp"

namespace thixis::mesh {
namespace {

template <class V>
typename V::HostMirror readable(const V& view) {
  return Kokkos::create_mirror_view_and_copy(typename V::HostMirror::memory_space(), view);
}

template <class Data>
HostView<Data> allocate_view(View<Data>& view, const std::string& name, LocalIndex size) {
  view = View<Data>(Kokkos::view_alloc(Kokkos::WithoutInitializing, "thixis::mesh::" + name), size);
  return Kokkos::create_mirror_view(view);
}

}  // namespace

HostMesh on_host(const Mesh& mesh) {
  HostMesh host;
  host.coordinates = readable(mesh.coordinates);
  host.parameter = mesh.chart == Chart::identity ? host.coordinates : readable(mesh.parameter);
  host.cell_vertices = readable(mesh.cell_vertices);
  host.cell_faces = readable(mesh.cell_faces);
  host.face_vertices = readable(mesh.face_vertices);
  host.face_cells = readable(mesh.face_cells);
  host.face_tag = readable(mesh.face_tag);
  return host;
}

HostMesh allocate(Mesh& mesh) {
  HostMesh host;
  host.coordinates = allocate_view(mesh.coordinates, "coordinates", mesh.vertices);
  if (mesh.chart == Chart::identity) {
    mesh.parameter = mesh.coordinates;
    host.parameter = host.coordinates;
  } else {
    host.parameter = allocate_view(mesh.parameter, "parameter", mesh.vertices);
  }
  host.cell_vertices = allocate_view(mesh.cell_vertices, "cell_vertices", mesh.cells);
  host.cell_faces = allocate_view(mesh.cell_faces, "cell_faces", mesh.cells);
  host.face_vertices = allocate_view(mesh.face_vertices, "face_vertices", mesh.faces);
  host.face_cells = allocate_view(mesh.face_cells, "face_cells", mesh.faces);
  host.face_tag = allocate_view(mesh.face_tag, "face_tag", mesh.faces);

  mesh.cell_id.resize(mesh.cells);
  mesh.cell_owner.resize(mesh.cells);
  mesh.vertex_id.resize(mesh.vertices);
  mesh.vertex_owner.resize(mesh.vertices);
  mesh.face_id.resize(mesh.faces);
  mesh.face_owner.resize(mesh.faces);
  return host;
}

void commit(const HostMesh& filled, Mesh& mesh) {
  Kokkos::deep_copy(mesh.coordinates, filled.coordinates);
  if (mesh.chart != Chart::identity) Kokkos::deep_copy(mesh.parameter, filled.parameter);
  Kokkos::deep_copy(mesh.cell_vertices, filled.cell_vertices);
  Kokkos::deep_copy(mesh.cell_faces, filled.cell_faces);
  Kokkos::deep_copy(mesh.face_vertices, filled.face_vertices);
  Kokkos::deep_copy(mesh.face_cells, filled.face_cells);
  Kokkos::deep_copy(mesh.face_tag, filled.face_tag);
}

}  // namespace thixis::mesh
