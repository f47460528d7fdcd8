#include "distribute.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "patches.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::mesh {
namespace {

std::vector<int> owners_of_first_children(const std::vector<int>& owner) {
  std::vector<int> coarse(owner.size() / 4);
  for (std::size_t K = 0; K < coarse.size(); ++K) coarse[K] = owner[4 * K];
  return coarse;
}

/// Numbers what is used 0, 1, ... in the old order; -1 for the rest.
struct Renumbering {
  std::vector<LocalIndex> number, used;

  explicit Renumbering(LocalIndex size) : number(size, -1) {}
  void use(LocalIndex old) { number[old] = 0; }
  void finish() {
    for (std::size_t old = 0; old < number.size(); ++old)
      if (number[old] == 0) {
        number[old] = static_cast<LocalIndex>(used.size());
        used.push_back(static_cast<LocalIndex>(old));
      }
  }
  LocalIndex count() const { return static_cast<LocalIndex>(used.size()); }
};

template <class T>
std::vector<T> selected(const std::vector<T>& all, const std::vector<LocalIndex>& which) {
  std::vector<T> values;
  if (all.empty()) return values;
  values.reserve(which.size());
  for (const LocalIndex k : which) values.push_back(all[k]);
  return values;
}

template <class From, class To>
void select_rows(const From& from, const std::vector<LocalIndex>& which, const To& to) {
  for (std::size_t row = 0; row < which.size(); ++row)
    for (int d = 0; d < static_cast<int>(from.extent(1)); ++d) to(row, d) = from(which[row], d);
}

/// Those of `candidates` whose parents share a vertex with the parent of one of `cells`: the patch of a coarse vertex has all its children
/// on the rank that owns the vertex.
std::vector<LocalIndex> near_parents(const Mesh& coarse, const Mesh& fine, const std::vector<LocalIndex>& cells,
                                     const std::vector<LocalIndex>& candidates) {
  std::vector<LocalIndex> all(coarse.cells);
  std::iota(all.begin(), all.end(), 0);
  std::vector<bool> near(coarse.cells, false);
  for (const LocalIndex parent : cells_touching(coarse, selected(fine.cell_parent, cells), all)) near[parent] = true;
  std::vector<LocalIndex> found;
  for (const LocalIndex K : candidates)
    if (near[fine.cell_parent[K]]) found.push_back(K);
  return found;
}

}  // namespace

void set_owners(std::vector<int> cell_owner, Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  std::fill(mesh.vertex_owner.begin(), mesh.vertex_owner.end(), std::numeric_limits<int>::max());
  std::fill(mesh.face_owner.begin(), mesh.face_owner.end(), std::numeric_limits<int>::max());
  for (LocalIndex K = 0; K < mesh.cells; ++K)
    for (int i = 0; i < 3; ++i) {
      int &at_vertex = mesh.vertex_owner[host.cell_vertices(K, i)], &at_face = mesh.face_owner[host.cell_faces(K, i)];
      at_vertex = std::min(at_vertex, cell_owner[K]);
      at_face = std::min(at_face, cell_owner[K]);
    }
  mesh.cell_owner = std::move(cell_owner);
}

Mesh extract(const Mesh& whole, const std::vector<LocalIndex>& kept, LocalIndex owned) {
  const HostMesh in = on_host(whole);
  std::vector<LocalIndex> cell_number(whole.cells, -1);
  Renumbering vertices(whole.vertices), faces(whole.faces);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    cell_number[kept[k]] = static_cast<LocalIndex>(k);
    for (int i = 0; i < 3; ++i) {
      vertices.use(in.cell_vertices(kept[k], i));
      faces.use(in.cell_faces(kept[k], i));
    }
  }
  vertices.finish();
  faces.finish();

  Mesh part;
  part.comm = whole.comm;
  part.global_cells = whole.global_cells;
  part.global_vertices = whole.global_vertices;
  part.global_faces = whole.global_faces;
  part.owned_cells = owned;
  part.cells = static_cast<LocalIndex>(kept.size());
  part.vertices = vertices.count();
  part.faces = faces.count();
  part.tags = whole.tags;
  part.refinement = whole.refinement;
  part.chart = whole.chart;

  const HostMesh out = allocate(part);
  select_rows(in.coordinates, vertices.used, out.coordinates);
  select_rows(in.parameter, vertices.used, out.parameter);
  for (LocalIndex K = 0; K < part.cells; ++K)
    for (int i = 0; i < 3; ++i) {
      out.cell_vertices(K, i) = vertices.number[in.cell_vertices(kept[K], i)];
      out.cell_faces(K, i) = faces.number[in.cell_faces(kept[K], i)];
    }
  for (LocalIndex F = 0; F < part.faces; ++F) {
    const LocalIndex old = faces.used[F];
    out.face_tag(F) = in.face_tag(old);
    for (int i = 0; i < 2; ++i) {
      const LocalIndex K = in.face_cells(old, i);
      out.face_vertices(F, i) = vertices.number[in.face_vertices(old, i)];
      out.face_cells(F, i) = K < 0 ? -1 : cell_number[K];
    }
  }
  commit(out, part);

  part.cell_id = selected(whole.cell_id, kept);
  part.cell_owner = selected(whole.cell_owner, kept);
  part.vertex_id = selected(whole.vertex_id, vertices.used);
  part.vertex_owner = selected(whole.vertex_owner, vertices.used);
  part.face_id = selected(whole.face_id, faces.used);
  part.face_owner = selected(whole.face_owner, faces.used);
  part.cell_parent = selected(whole.cell_parent, kept);
  part.cell_parent_id = selected(whole.cell_parent_id, kept);
  part.cell_shape = selected(whole.cell_shape, kept);
  part.vertex_parents = selected(whole.vertex_parents, vertices.used);
  find_ghost_patch_cells(part);
  return part;
}

void distribute(Hierarchy& hierarchy) {
  Mesh& finest = hierarchy.levels.back();
  if (finest.comm.size() == 1) return;

  std::vector<int> owner = partition(finest, finest.comm);
  for (auto level = hierarchy.levels.rbegin(); level != hierarchy.levels.rend(); ++level) {
    std::vector<int> coarse_owner = owners_of_first_children(owner);
    set_owners(std::move(owner), *level);
    owner = std::move(coarse_owner);
  }

  std::vector<LocalIndex> parent_number;  // of the cells of the next coarser level, by their old number
  const Mesh* coarse = nullptr;
  for (Mesh& level : hierarchy.levels) {
    std::vector<LocalIndex> kept, others;
    for (LocalIndex K = 0; K < level.cells; ++K) (level.cell_owner[K] == level.comm.rank() ? kept : others).push_back(K);
    const auto owned = static_cast<LocalIndex>(kept.size());

    for (LocalIndex& parent : level.cell_parent) parent = parent_number[parent];
    if (&level == &finest) others = coarse ? near_parents(*coarse, level, kept, others) : cells_touching(level, kept, others);
    kept.insert(kept.end(), others.begin(), others.end());
    parent_number.assign(level.cells, -1);
    for (std::size_t k = 0; k < kept.size(); ++k) parent_number[kept[k]] = static_cast<LocalIndex>(k);
    level = extract(level, kept, owned);
    coarse = &level;
  }
}

}  // namespace thixis::mesh
