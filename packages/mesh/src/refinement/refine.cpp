#include "patches.hpp"
#include "refinement/cut.hpp"
#include "refinement/refine_kernels.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::mesh {
namespace {

/// Puts a vertex on the face F and halves it: half h = 0, 1 is 2F + h and holds the end vertex h. Leaves face_cells of the halves empty.
struct CutFaces {
  const Mesh& coarse;
  HostMesh in;
  Mesh& fine;
  HostMesh out;

  void operator()(LocalIndex F) const {
    const LocalIndex m = coarse.vertices + F;
    put_on_midpoint(in, F, m, fine, out);
    fine.vertex_id[m] = coarse.global_vertices + coarse.face_id[F];
    fine.vertex_owner[m] = coarse.face_owner[F];

    for (int h = 0; h < 2; ++h) {
      const LocalIndex H = 2 * F + h;
      out.face_vertices(H, 0) = in.face_vertices(F, h), out.face_vertices(H, 1) = m;
      out.face_cells(H, 0) = out.face_cells(H, 1) = -1;
      out.face_tag(H) = in.face_tag(F);
      fine.face_id[H] = 2 * coarse.face_id[F] + h;
      fine.face_owner[H] = coarse.face_owner[F];
    }
  }
};

/// Cuts the cell K into 4K..4K+3, with its interior faces 2 faces + 3K + k. Needs the halves of its faces.
struct CutCells {
  const Mesh& coarse;
  HostMesh in;
  Mesh& fine;
  HostMesh out;
  Cut cut;  ///< into four

  void operator()(LocalIndex K) const {
    const LocalIndex point[6] = {in.cell_vertices(K, 0),
                                 in.cell_vertices(K, 1),
                                 in.cell_vertices(K, 2),
                                 coarse.vertices + in.cell_faces(K, 0),
                                 coarse.vertices + in.cell_faces(K, 1),
                                 coarse.vertices + in.cell_faces(K, 2)};
    for (int k = 0; k < 3; ++k) add_interior_face(K, k, point);
    for (int c = 0; c < 4; ++c) add_child(K, c, point);
  }

  void add_interior_face(LocalIndex K, int k, const LocalIndex* point) const {
    const LocalIndex F = interior_face(K, k);
    const LocalIndex a = point[cut.interior[k][0]], b = point[cut.interior[k][1]];
    const bool ascending = fine.vertex_id[a] < fine.vertex_id[b];
    out.face_vertices(F, 0) = ascending ? a : b, out.face_vertices(F, 1) = ascending ? b : a;
    out.face_tag(F) = -1;
    fine.face_id[F] = 2 * coarse.global_faces + 3 * coarse.cell_id[K] + k;
    fine.face_owner[F] = coarse.cell_owner[K];
  }

  void add_child(LocalIndex K, int c, const LocalIndex* point) const {
    const LocalIndex child = 4 * K + c;
    for (int i = 0; i < 3; ++i) out.cell_vertices(child, i) = point[cut.child[c][i]];
    for (int i = 0; i < 3; ++i) {
      const int code = cut.face[c][i];
      const LocalIndex F = code < 3 ? interior_face(K, code) : half_face(K, (code - 3) / 3, point[(code - 3) % 3]);
      out.cell_faces(child, i) = F;
      out.face_cells(F, out.face_vertices(F, 0) == out.cell_vertices(child, (i + 1) % 3) ? 0 : 1) = child;
    }
    fine.cell_id[child] = 4 * coarse.cell_id[K] + c;
    fine.cell_owner[child] = coarse.cell_owner[K];
    fine.cell_parent[child] = K;
    fine.cell_parent_id[child] = coarse.cell_id[K];
    fine.cell_shape[child] = cut.shape[c];
  }

  LocalIndex interior_face(LocalIndex K, int k) const { return 2 * coarse.faces + 3 * K + k; }
  LocalIndex half_face(LocalIndex K, int k, LocalIndex vertex) const {
    const LocalIndex F = in.cell_faces(K, k);
    return 2 * F + (in.face_vertices(F, 0) == vertex ? 0 : 1);
  }
};

}  // namespace

Mesh refine(const Mesh& coarse) {
  Mesh fine;
  fine.comm = coarse.comm;
  fine.global_cells = 4 * coarse.global_cells;
  fine.global_vertices = coarse.global_vertices + coarse.global_faces;
  fine.global_faces = 2 * coarse.global_faces + 3 * coarse.global_cells;
  fine.owned_cells = 4 * coarse.owned_cells;
  fine.cells = 4 * coarse.cells;
  fine.vertices = coarse.vertices + coarse.faces;
  fine.faces = 2 * coarse.faces + 3 * coarse.cells;
  fine.tags = coarse.tags;
  fine.refinement = coarse.refinement;
  fine.chart = coarse.chart;
  fine.cell_parent.resize(fine.cells);
  fine.cell_parent_id.resize(fine.cells);
  fine.cell_shape.resize(fine.cells);
  fine.vertex_parents.resize(fine.vertices);

  const HostMesh in = on_host(coarse), out = allocate(fine);
  launch("keep_vertices", coarse.vertices, KeepVertices{coarse, in, fine, out});
  launch("cut_faces", coarse.faces, CutFaces{coarse, in, fine, out});
  const Cut& cut = coarse.refinement == Refinement::red ? red : bisections[3];
  // An interior face has both its cells among the children, so that no entry of face_cells stays unset.
  launch("cut_cells", coarse.cells, CutCells{coarse, in, fine, out, cut});
  commit(out, fine);
  find_ghost_patch_cells(fine);
  return fine;
}

}  // namespace thixis::mesh
