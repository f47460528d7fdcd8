#include "refinement/bisect.hpp"

#include <algorithm>
#include <limits>

#include "patches.hpp"
#include "refinement/cut.hpp"
#include "refinement/refine_kernels.hpp"
#include "thixis/core/error.hpp"

namespace thixis::mesh {
namespace {

/// Marks the faces of marked cells, and the refinement edge of every cell that has a marked face.
std::vector<char> marked_faces(const Mesh& mesh, const HostMesh& host, const std::vector<GlobalIndex>& cells,
                               const std::vector<std::uint8_t>& edge) {
  std::vector<char> marked(mesh.faces, 0);
  std::vector<LocalIndex> pending;  // faces whose cells were not looked at
  const auto mark = [&](LocalIndex F) {
    if (marked[F]) return;
    marked[F] = 1;
    pending.push_back(F);
  };
  for (const GlobalIndex K : cells)
    for (int i = 0; i < 3; ++i) mark(host.cell_faces(K, i));
  while (!pending.empty()) {
    const LocalIndex F = pending.back();
    pending.pop_back();
    for (int s = 0; s < 2; ++s)
      if (const LocalIndex K = host.face_cells(F, s); K >= 0) mark(host.cell_faces(K, edge[K]));
  }
  return marked;
}

/// Where the parts of each entity are numbered in the new level.
struct Plan {
  std::vector<LocalIndex> vertex;    ///< on each face; -1: it is not cut
  std::vector<LocalIndex> face;      ///< of each face: its first part
  std::vector<LocalIndex> interior;  ///< of each cell: the first of the new faces inside
  std::vector<LocalIndex> cell;      ///< of each cell: its first child
  std::vector<std::int8_t> cut;      ///< of each cell: index into bisections; -1: whole
  GlobalIndex vertices = 0, faces = 0, cells = 0;
};

Plan plan(const Mesh& mesh, const HostMesh& host, const std::vector<char>& marked, const std::vector<std::uint8_t>& edge) {
  Plan p;
  p.vertex.resize(mesh.faces);
  p.face.resize(mesh.faces);
  p.interior.resize(mesh.cells);
  p.cell.resize(mesh.cells);
  p.cut.resize(mesh.cells);
  p.vertices = mesh.vertices;
  const auto next = [](GlobalIndex& count, int more) {
    const auto first = static_cast<LocalIndex>(std::min<GlobalIndex>(count, std::numeric_limits<LocalIndex>::max()));
    count += more;
    return first;
  };
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    p.vertex[F] = marked[F] ? next(p.vertices, 1) : -1;
    p.face[F] = next(p.faces, marked[F] ? 2 : 1);
  }
  for (LocalIndex K = 0; K < mesh.cells; ++K) {
    const auto is_marked = [&](int i) { return marked[host.cell_faces(K, (edge[K] + i) % 3)] != 0; };
    p.cut[K] = static_cast<std::int8_t>(!is_marked(0) ? -1 : (is_marked(2) ? 1 : 0) + (is_marked(1) ? 2 : 0));
    const int children = p.cut[K] < 0 ? 1 : bisections[p.cut[K]].children;
    p.cell[K] = next(p.cells, children);
    p.interior[K] = next(p.faces, children - 1);
  }
  return p;
}

/// Cuts the face F where the plan has a vertex on it. Leaves face_cells of the parts empty.
struct CutFaces {
  HostMesh in;
  const Plan& plan;
  Mesh& fine;
  HostMesh out;

  void operator()(LocalIndex F) const {
    const LocalIndex m = plan.vertex[F], first = plan.face[F];
    if (m < 0) {
      add_part(F, first, in.face_vertices(F, 0), in.face_vertices(F, 1));
      return;
    }
    put_on_midpoint(in, F, m, fine, out);
    fine.vertex_id[m] = m;
    for (int h = 0; h < 2; ++h) add_part(F, first + h, in.face_vertices(F, h), m);
  }

  void add_part(LocalIndex F, LocalIndex P, LocalIndex a, LocalIndex b) const {
    out.face_vertices(P, 0) = a, out.face_vertices(P, 1) = b;
    out.face_cells(P, 0) = out.face_cells(P, 1) = -1;
    out.face_tag(P) = in.face_tag(F);
    fine.face_id[P] = P;
  }
};

/// Makes the children of the cell K with the faces inside. Needs the parts of its faces.
struct CutCells {
  HostMesh in;
  const Plan& plan;
  const std::vector<std::uint8_t>& edge;
  Mesh& fine;
  HostMesh out;
  std::vector<std::uint8_t>& fine_edge;

  void operator()(LocalIndex K) const {
    if (plan.cut[K] < 0) {
      keep(K);
      return;
    }
    const Cut& cut = bisections[plan.cut[K]];
    LocalIndex point[6];  // the six of the cut, counted from the vertex opposite the refinement edge on
    for (int i = 0; i < 3; ++i) {
      point[i] = in.cell_vertices(K, turned(K, i));
      point[3 + i] = plan.vertex[in.cell_faces(K, turned(K, i))];
    }
    for (int k = 0; k < cut.children - 1; ++k) {
      const LocalIndex F = plan.interior[K] + k, a = point[cut.interior[k][0]], b = point[cut.interior[k][1]];
      out.face_vertices(F, 0) = std::min(a, b), out.face_vertices(F, 1) = std::max(a, b);
      out.face_tag(F) = -1;
      fine.face_id[F] = F;
    }
    for (int c = 0; c < cut.children; ++c) {
      const LocalIndex child = plan.cell[K] + c;
      for (int i = 0; i < 3; ++i) out.cell_vertices(child, i) = point[cut.child[c][i]];
      for (int i = 0; i < 3; ++i) {
        const int code = cut.face[c][i];
        join(child, i, code < 3 ? plan.interior[K] + code : part_of_face(K, (code - 3) / 3, point[(code - 3) % 3]));
      }
      describe(child, K, static_cast<ChildShape>(cut.shape[c] + shapes_per_edge * edge[K]), 0);
    }
  }

  int turned(LocalIndex K, int i) const { return (edge[K] + i) % 3; }

  void keep(LocalIndex K) const {
    const LocalIndex child = plan.cell[K];
    for (int i = 0; i < 3; ++i) out.cell_vertices(child, i) = in.cell_vertices(K, i);
    for (int i = 0; i < 3; ++i) join(child, i, plan.face[in.cell_faces(K, i)]);
    describe(child, K, 0, edge[K]);
  }

  /// The part of the face k, turned, at this vertex.
  LocalIndex part_of_face(LocalIndex K, int k, LocalIndex vertex) const {
    const LocalIndex F = in.cell_faces(K, turned(K, k));
    return plan.face[F] + (plan.vertex[F] < 0 || in.face_vertices(F, 0) == vertex ? 0 : 1);
  }

  void join(LocalIndex child, int i, LocalIndex F) const {
    out.cell_faces(child, i) = F;
    out.face_cells(F, out.face_vertices(F, 0) == out.cell_vertices(child, (i + 1) % 3) ? 0 : 1) = child;
  }

  void describe(LocalIndex child, LocalIndex K, ChildShape shape, std::uint8_t child_edge) const {
    fine.cell_id[child] = child;
    fine.cell_parent[child] = K;
    fine.cell_parent_id[child] = K;
    fine.cell_shape[child] = shape;
    fine_edge[child] = child_edge;
  }
};

Mesh empty_level(const Mesh& whole, const Plan& plan) {
  constexpr GlobalIndex limit = 500000000;
  if (plan.cells > limit)
    throw core::InputError("adaptive refinement: the mesh would have more than 500 million cells; ask for a larger error or fewer cells.");
  Mesh fine;
  fine.comm = whole.comm;
  fine.global_cells = fine.owned_cells = fine.cells = static_cast<LocalIndex>(plan.cells);
  fine.global_vertices = fine.vertices = static_cast<LocalIndex>(plan.vertices);
  fine.global_faces = fine.faces = static_cast<LocalIndex>(plan.faces);
  fine.tags = whole.tags;
  fine.refinement = Refinement::bisection;
  fine.chart = whole.chart;
  fine.cell_parent.resize(fine.cells);
  fine.cell_parent_id.resize(fine.cells);
  fine.cell_shape.resize(fine.cells);
  fine.vertex_parents.resize(fine.vertices);
  return fine;
}

}  // namespace

std::vector<std::uint8_t> longest_faces(const Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  std::vector<double> length(mesh.faces);
  for (LocalIndex F = 0; F < mesh.faces; ++F) length[F] = face_geometry(host.coordinates, host.face_vertices, F).length;
  std::vector<std::uint8_t> longest(mesh.cells);
  for (LocalIndex K = 0; K < mesh.cells; ++K) {
    const auto face = [&](int i) { return host.cell_faces(K, i); };
    // lengths that only rounding tells apart are equal
    const double nearly = (1 - 1e-10) * std::max({length[face(0)], length[face(1)], length[face(2)]});
    int found = -1;
    const auto ends = [&](int i) {
      return std::pair(mesh.vertex_id[host.face_vertices(face(i), 0)], mesh.vertex_id[host.face_vertices(face(i), 1)]);
    };
    for (int i = 0; i < 3; ++i)
      if (length[face(i)] >= nearly && (found < 0 || ends(i) < ends(found))) found = i;
    longest[K] = static_cast<std::uint8_t>(found);
  }
  return longest;
}

Mesh bisect(const Mesh& whole, const std::vector<GlobalIndex>& marked, std::vector<std::uint8_t>& edge) {
  const HostMesh in = on_host(whole);
  const Plan cuts = plan(whole, in, marked_faces(whole, in, marked, edge), edge);
  Mesh fine = empty_level(whole, cuts);
  const HostMesh out = allocate(fine);
  std::vector<std::uint8_t> fine_edge(fine.cells);
  launch("keep_vertices", whole.vertices, KeepVertices{whole, in, fine, out});
  launch("cut_faces", whole.faces, CutFaces{in, cuts, fine, out});
  launch("cut_cells", whole.cells, CutCells{in, cuts, edge, fine, out, fine_edge});
  commit(out, fine);
  find_ghost_patch_cells(fine);
  edge = std::move(fine_edge);
  return fine;
}

}  // namespace thixis::mesh
