#include "patches/patches.hpp"

#include <algorithm>
#include <string>

#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/mesh/to_view.hpp"

namespace thixis::equilibration {
namespace {

/// Vertex i of a mesh cell.
struct Corner {
  LocalIndex cell;
  int i;
  bool operator==(Corner other) const { return cell == other.cell && i == other.i; }
};

class Surroundings {
 public:
  explicit Surroundings(const mesh::Mesh& mesh) : mesh_(mesh), host_(mesh::on_host(mesh)) {}

  LocalIndex vertex(Corner c) const { return host_.cell_vertices(c.cell, c.i); }
  LocalIndex face_before(Corner c) const { return host_.cell_faces(c.cell, (c.i + 2) % 3); }
  LocalIndex face_after(Corner c) const { return host_.cell_faces(c.cell, (c.i + 1) % 3); }
  int tag(LocalIndex F) const { return host_.face_tag(F); }
  int end(LocalIndex F, LocalIndex a) const { return host_.face_vertices(F, 0) == a ? 0 : 1; }

  /// The corners around the vertex of `seed`, counter-clockwise from the boundary or from the cell of lowest id.
  std::vector<Corner> around(Corner seed) const {
    std::vector<Corner> corners = {seed};
    for (Corner c = across(seed, face_after(seed)); c.cell >= 0 && !(c == seed); c = across(c, face_after(c))) corners.push_back(c);
    if (tag(face_after(corners.back())) < 0) {
      std::rotate(corners.begin(),
                  std::min_element(corners.begin(), corners.end(),
                                   [&](Corner a, Corner b) { return mesh_.cell_id[a.cell] < mesh_.cell_id[b.cell]; }),
                  corners.end());
      return corners;
    }
    std::vector<Corner> before;
    for (Corner c = across(seed, face_before(seed)); c.cell >= 0; c = across(c, face_before(c))) before.push_back(c);
    corners.insert(corners.begin(), before.rbegin(), before.rend());
    return corners;
  }

 private:
  Corner across(Corner c, LocalIndex F) const {
    const LocalIndex K = mesh::neighbour(host_.face_cells, F, c.cell);
    for (int i = 0; i < 3 && K >= 0; ++i)
      if (host_.cell_vertices(K, i) == vertex(c)) return {K, i};
    return {-1, 0};
  }

  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
};

}  // namespace

Patches make_patches(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q) {
  const Surroundings mesh_around(mesh);
  const auto listed = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells);
  std::vector<LocalIndex> position(mesh.cells, -1);
  for (LocalIndex k = 0; k < listed.extent_int(0); ++k) position[listed(k)] = k;

  Patches all;
  all.spoke = View<LocalIndex* [3][2]>("thixis::equilibration::spoke", cells.extent(0));
  const auto spoke = Kokkos::create_mirror_view(all.spoke);
  Kokkos::deep_copy(spoke, -1);

  std::vector<Patch> patches;
  std::vector<LocalIndex> corners;
  std::vector<GivenSpoke> given;
  std::vector<bool> seen(mesh.vertices, false);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex a = mesh_around.vertex({K, i});
      if (seen[a]) continue;
      seen[a] = true;

      const auto around = mesh_around.around({K, i});
      const LocalIndex first = mesh_around.face_before(around.front()), last = mesh_around.face_after(around.back());
      const bool closed = mesh_around.tag(first) < 0;
      Patch patch;
      patch.corner = static_cast<LocalIndex>(corners.size());
      patch.spoke = all.spokes;
      patch.cells = static_cast<int>(around.size());
      patch.spokes = patch.cells + (closed ? 0 : 1);
      patch.given_first = !closed && !held[mesh_around.tag(first)];
      patch.given_last = !closed && !held[mesh_around.tag(last)];
      patch.first_free = patch.given_first ? 1 : 0;
      patch.free = patch.spokes - patch.first_free - (patch.given_last ? 1 : 0);
      patch.unknowns = all.unknowns;
      patch.factor = all.factors;
      for (int m = 0; m < patch.cells; ++m) {
        const LocalIndex k = position[around[m].cell];
        corners.push_back(3 * k + around[m].i);
        spoke(k, around[m].i, 0) = patch.spoke + m;
        spoke(k, around[m].i, 1) = patch.spoke + (m + 1) % patch.spokes;
      }
      if (patch.given_first) given.push_back({patch.spoke, first, mesh_around.end(first, a), -1});
      if (patch.given_last) given.push_back({patch.spoke + patch.cells, last, mesh_around.end(last, a), 1});
      const GlobalIndex n = patch.size(q);
      all.spokes += patch.spokes;
      all.unknowns += patch.size(q);
      all.factors += n * (n + 1) / 2;
      patches.push_back(patch);
    }

  Kokkos::deep_copy(all.spoke, spoke);
  all.patch = mesh::to_view("thixis::equilibration::patch", patches);
  all.corner = mesh::to_view("thixis::equilibration::corner", corners);
  all.given_spokes = mesh::to_view("thixis::equilibration::given_spokes", given);
  all.given = View<bool*>("thixis::equilibration::given", all.spokes);
  const auto is_given = Kokkos::create_mirror_view(all.given);
  for (const GivenSpoke& s : given) is_given(s.spoke) = true;
  Kokkos::deep_copy(all.given, is_given);
  return all;
}

}  // namespace thixis::equilibration
