#include "thixis/mesh/check.hpp"

#include <algorithm>
#include <cmath>

#include "checks/check_parents.hpp"
#include "patches.hpp"
#include "refinement/adaptive.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::mesh {
namespace {

/// What makes all other checks safe to run.
void check_indices(const Mesh& mesh, const HostMesh& host, Findings& findings) {
  const auto differs = [](std::size_t size, LocalIndex count) { return size != static_cast<std::size_t>(count); };
  long long sizes = 0;
  for (const std::size_t size : {host.cell_vertices.extent(0), host.cell_faces.extent(0), mesh.cell_id.size(), mesh.cell_owner.size()})
    sizes += differs(size, mesh.cells);
  for (const std::size_t size : {host.coordinates.extent(0), host.parameter.extent(0), mesh.vertex_id.size(), mesh.vertex_owner.size()})
    sizes += differs(size, mesh.vertices);
  for (const std::size_t size :
       {host.face_vertices.extent(0), host.face_cells.extent(0), host.face_tag.extent(0), mesh.face_id.size(), mesh.face_owner.size()})
    sizes += differs(size, mesh.faces);
  sizes += mesh.owned_cells > mesh.cells ? 1 : 0;
  findings.add("arrays of another size than their entities", sizes);
  const bool readable = sizes == 0;

  findings.count("cells with numbers of vertices or faces out of range", readable ? mesh.cells : 0, [&](LocalIndex K) {
    for (int i = 0; i < 3; ++i)
      if (!inside(host.cell_vertices(K, i), mesh.vertices) || !inside(host.cell_faces(K, i), mesh.faces)) return true;
    return false;
  });
  findings.count("faces with numbers of vertices, cells or tags out of range", readable ? mesh.faces : 0, [&](LocalIndex F) {
    for (int i = 0; i < 2; ++i)
      if (!inside(host.face_vertices(F, i), mesh.vertices) || !inside(host.face_cells(F, i) + 1, mesh.cells + 1)) return true;
    return !inside(host.face_tag(F) + 1, static_cast<LocalIndex>(mesh.tags.size()) + 1) || first_cell(host.face_cells, F) < 0;
  });
}

void check_cells(const Mesh& mesh, const HostMesh& host, Findings& findings) {
  findings.count("cells that are not counter-clockwise", mesh.cells, [&](LocalIndex K) {
    return !(cell_area(host.coordinates, host.cell_vertices, K) > 0 && cell_area(host.parameter, host.cell_vertices, K) > 0);
  });
  findings.count("cells whose faces are not opposite their vertices", mesh.cells, [&](LocalIndex K) {
    for (int i = 0; i < 3; ++i) {
      const LocalIndex F = host.cell_faces(K, i), a = host.cell_vertices(K, (i + 1) % 3), b = host.cell_vertices(K, (i + 2) % 3);
      const int slot = host.face_vertices(F, 0) == a ? 0 : 1;  // 0: the face runs counter-clockwise
      if (host.face_vertices(F, slot) != a || host.face_vertices(F, 1 - slot) != b || host.face_cells(F, slot) != K) return true;
    }
    return false;
  });
  findings.count("owned cells that are not in front of the others", mesh.cells,
                 [&](LocalIndex K) { return (mesh.cell_owner[K] == mesh.comm.rank()) != (K < mesh.owned_cells); });
}

void check_faces(const Mesh& mesh, const HostMesh& host, Findings& findings) {
  findings.count("faces not from the lower to the higher id", mesh.faces,
                 [&](LocalIndex F) { return mesh.vertex_id[host.face_vertices(F, 0)] >= mesh.vertex_id[host.face_vertices(F, 1)]; });
  findings.count("faces with cells that do not have them", mesh.faces, [&](LocalIndex F) {
    for (int slot = 0; slot < 2; ++slot) {
      const LocalIndex K = host.face_cells(F, slot);
      if (K >= 0 && host.cell_faces(K, local_face(host.cell_faces, K, F)) != F) return true;
    }
    return false;
  });
  findings.count("faces with a tag that have two cells", mesh.faces,
                 [&](LocalIndex F) { return host.face_tag(F) >= 0 && host.face_cells(F, 0) >= 0 && host.face_cells(F, 1) >= 0; });
}

void check_patches(const Mesh& mesh, const HostMesh& host, Findings& findings) {
  std::vector<bool> needed(mesh.vertices, false);
  for (LocalIndex v = 0; v < mesh.vertices; ++v) needed[v] = mesh.vertex_owner[v] == mesh.comm.rank();
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i) needed[host.cell_vertices(K, i)] = true;
  findings.count("faces of needed patches that lack a cell", mesh.faces, [&](LocalIndex F) {
    const bool open = host.face_tag(F) < 0 && (host.face_cells(F, 0) < 0 || host.face_cells(F, 1) < 0);
    return open && (needed[host.face_vertices(F, 0)] || needed[host.face_vertices(F, 1)]);
  });

  Mesh expected = mesh;
  find_ghost_patch_cells(expected);
  const auto listed = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mesh.ghost_patch_cells);
  const auto right = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), expected.ghost_patch_cells);
  bool same = listed.extent(0) == right.extent(0);
  for (std::size_t k = 0; same && k < right.extent(0); ++k) same = listed(k) == right(k);
  findings.add("ranks with a wrong list of ghost patch cells", same ? 0 : 1);
}

/// An entity as one rank holds it.
struct Holding {
  GlobalIndex id;
  int owner, holder;
  bool operator<(const Holding& other) const { return id < other.id; }
};

/// Collective. Counts on the root the ids 0..global-1 that are not held by their owner, or have several owners, and ids out of range.
long long badly_owned(const core::Comm& comm, const std::vector<GlobalIndex>& id, const std::vector<int>& owner, GlobalIndex global) {
  std::vector<Holding> here;
  for (std::size_t k = 0; k < id.size(); ++k) here.push_back({id[k], owner[k], comm.rank()});
  std::vector<Holding> all = comm.gather_on_root(here);
  if (!comm.root()) return 0;

  std::sort(all.begin(), all.end());
  long long bad = 0, seen = 0;
  for (auto first = all.begin(); first != all.end();) {
    const auto last = std::find_if(first, all.end(), [&](const Holding& h) { return h.id != first->id; });
    const bool one_owner = std::all_of(first, last, [&](const Holding& h) { return h.owner == first->owner; });
    const auto holders = std::count_if(first, last, [](const Holding& h) { return h.owner == h.holder; });
    if (!one_owner || holders != 1 || first->id < 0 || first->id >= global) ++bad;
    ++seen;
    first = last;
  }
  return bad + std::abs(seen - global);
}

void check_ids(const Mesh& mesh, Findings& findings) {
  findings.add("ids of cells without exactly one owner", badly_owned(mesh.comm, mesh.cell_id, mesh.cell_owner, mesh.global_cells));
  findings.add("ids of vertices without exactly one owner",
               badly_owned(mesh.comm, mesh.vertex_id, mesh.vertex_owner, mesh.global_vertices));
  findings.add("ids of faces without exactly one owner", badly_owned(mesh.comm, mesh.face_id, mesh.face_owner, mesh.global_faces));
}

}  // namespace

std::vector<std::string> check(const Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  Findings indices(mesh.comm);
  check_indices(mesh, host, indices);
  std::vector<std::string> found = indices.sentences();
  if (!found.empty()) return found;

  Findings findings(mesh.comm);
  check_cells(mesh, host, findings);
  check_faces(mesh, host, findings);
  check_patches(mesh, host, findings);
  check_ids(mesh, findings);
  return findings.sentences();
}

std::vector<std::string> check(const Hierarchy& hierarchy) {
  std::vector<std::string> found;
  for (std::size_t j = 0; j < hierarchy.levels.size(); ++j) {
    std::vector<std::string> level = check(hierarchy.levels[j]);
    if (j > 0 && found.empty() && level.empty()) {
      Findings findings(hierarchy.levels[j].comm);
      const bool uniform = !hierarchy.adaptive || static_cast<int>(j) < hierarchy.adaptive->uniform_levels;
      check_parents(hierarchy.levels[j - 1], hierarchy.levels[j], uniform, findings);
      level = findings.sentences();
    }
    for (const std::string& sentence : level) found.push_back("level " + std::to_string(j) + ": " + sentence);
  }
  return found;
}

}  // namespace thixis::mesh
