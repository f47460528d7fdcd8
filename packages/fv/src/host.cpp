#include "thixis/fv/host.hpp"

namespace thixis::fv {
namespace {

/// All pairs of a View of the grid and its place on the host.
template <class G, class Action>
void for_each_view(G& grid, HostGrid& host, Action&& action) {
  action(grid.centre, host.centre);
  action(grid.barycentre, host.barycentre);
  action(grid.volume, host.volume);
  action(grid.diameter, host.diameter);
  action(grid.face_cells, host.face_cells);
  action(grid.face_area, host.face_area);
  action(grid.face_distance, host.face_distance);
  action(grid.face_centre, host.face_centre);
  action(grid.face_normal, host.face_normal);
  action(grid.face_tag, host.face_tag);
  action(grid.cell_face_begin, host.cell_face_begin);
  action(grid.cell_faces, host.cell_faces);
  action(grid.cell_vertices, host.cell_vertices);
  action(grid.vertex, host.vertex);
}

template <class V, class... Sizes>
void create(V& view, const char* name, Sizes... sizes) {
  view = V(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string("thixis::fv::") + name), sizes...);
}

}  // namespace

HostGrid on_host(const Grid& grid) {
  HostGrid host;
  for_each_view(grid, host, [](const auto& view, auto& mirror) {
    using Mirror = std::decay_t<decltype(mirror)>;
    mirror = Kokkos::create_mirror_view_and_copy(typename Mirror::memory_space(), view);
  });
  return host;
}

HostGrid allocate(Grid& grid, int corners) {
  create(grid.centre, "centre", grid.cells);
  create(grid.barycentre, "barycentre", grid.cells);
  create(grid.volume, "volume", grid.cells);
  create(grid.diameter, "diameter", grid.cells);
  create(grid.face_cells, "face_cells", grid.faces);
  create(grid.face_area, "face_area", grid.faces);
  create(grid.face_distance, "face_distance", grid.faces);
  create(grid.face_centre, "face_centre", grid.faces);
  create(grid.face_normal, "face_normal", grid.faces);
  create(grid.face_tag, "face_tag", grid.faces);
  create(grid.cell_face_begin, "cell_face_begin", grid.owned_cells + 1);
  create(grid.cell_faces, "cell_faces", grid.owned_cells * corners);
  create(grid.cell_vertices, "cell_vertices", grid.cells, corners);
  create(grid.vertex, "vertex", grid.vertices);
  grid.cell_id.resize(grid.cells);
  grid.cell_owner.resize(grid.cells);
  grid.face_id.resize(grid.faces);
  grid.vertex_id.resize(grid.vertices);

  HostGrid host;
  for_each_view(grid, host, [](const auto& view, auto& mirror) { mirror = Kokkos::create_mirror_view(view); });
  for (LocalIndex K = 0; K <= grid.owned_cells; ++K) host.cell_face_begin(K) = K * corners;
  return host;
}

void commit(const HostGrid& filled, Grid& grid) {
  HostGrid host = filled;
  for_each_view(grid, host, [](const auto& view, const auto& mirror) { Kokkos::deep_copy(view, mirror); });
}

}  // namespace thixis::fv
