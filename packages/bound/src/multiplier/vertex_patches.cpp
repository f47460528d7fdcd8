#include "multiplier/vertex_patches.hpp"

#include "thixis/mesh/host.hpp"

namespace thixis::bound {

VertexPatches vertex_patches(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells) {
  const auto host = mesh::on_host(mesh);
  const auto position = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells);
  std::vector<LocalIndex> number(mesh.vertices, -1), vertices;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i) {
      LocalIndex& n = number[host.cell_vertices(K, i)];
      if (n >= 0) continue;
      n = static_cast<LocalIndex>(vertices.size());
      vertices.push_back(host.cell_vertices(K, i));
    }
  const std::size_t count = vertices.size();
  VertexPatches patches{
      View<LocalIndex*>("thixis::bound::patch_vertex", count), View<LocalIndex*>("thixis::bound::patch_offset", count + 1), {}, {}};
  const auto vertex = Kokkos::create_mirror_view(patches.vertex), offset = Kokkos::create_mirror_view(patches.offset);
  for (std::size_t a = 0; a < count; ++a) vertex(a) = vertices[a];
  const auto each = [&](auto f) {
    for (int k = 0; k < position.extent_int(0); ++k)
      for (int i = 0; i < 3; ++i)
        if (const LocalIndex a = number[host.cell_vertices(position(k), i)]; a >= 0) f(a, k, i);
  };
  each([&](LocalIndex a, int, int) { ++offset(a + 1); });
  for (std::size_t a = 0; a < count; ++a) offset(a + 1) += offset(a);
  patches.cell = View<LocalIndex*>("thixis::bound::patch_cells", offset(count));
  patches.corner = View<int*>("thixis::bound::patch_corners", offset(count));
  const auto cell = Kokkos::create_mirror_view(patches.cell);
  const auto corner = Kokkos::create_mirror_view(patches.corner);
  std::vector<LocalIndex> next(offset.data(), offset.data() + count);
  each([&](LocalIndex a, int k, int i) {
    cell(next[a]) = k;
    corner(next[a]++) = i;
  });
  Kokkos::deep_copy(patches.vertex, vertex);
  Kokkos::deep_copy(patches.offset, offset);
  Kokkos::deep_copy(patches.cell, cell);
  Kokkos::deep_copy(patches.corner, corner);
  return patches;
}

}  // namespace thixis::bound
