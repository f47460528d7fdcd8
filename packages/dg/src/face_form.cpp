#include "face_form.hpp"

namespace thixis::dg {
namespace {

constexpr int most = reference::max_functions;

/// Each face has its k-th place among those that are asked for.
struct SetFaces {
  View<LocalIndex*[3]> vertices, cell_faces;
  View<LocalIndex*[2]> face_vertices, face_cells;
  View<const LocalIndex*> face;
  View<LocalIndex*[2]> cell, side;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int k) const {
    const LocalIndex F = face(k);
    for (int s = 0; s < 2; ++s) {
      const LocalIndex K = cell(k, s) = face_cells(F, s);
      if (K < 0) continue;
      const int f = mesh::local_face(cell_faces, K, F);
      side(k, s) = 2 * f + (face_vertices(F, 0) == vertices(K, (f + 1) % 3) ? 0 : 1);
    }
  }
};

struct FaceMatrices {
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<LocalIndex* [2]> face_vertices;
  Faces faces;
  Traces traces;
  Penalty penalty{};
  LocalIndex first = 0;
  Tensions mu;
  Matrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex k = first + e;
    const int n = traces.value.extent_int(2), on_face = traces.on_face.extent_int(1);
    const mesh::FaceGeometry F = mesh::face_geometry(x, face_vertices, faces.face(k));
    const double share = faces.cell(k, 0) >= 0 && faces.cell(k, 1) >= 0 ? 0.5 : 1.0;
    for (int i = 0; i < 2 * n; ++i)
      for (int j = 0; j < 2 * n; ++j) A(e, i, j) = 0;

    double slope[2][3];  // n·grad(lambda_a) in K+ and K-, times the share in the mean
    for (int s = 0; s < 2; ++s) {
      if (faces.cell(k, s) < 0) continue;
      const mesh::CellGeometry K = mesh::cell_geometry(x, vertices, faces.cell(k, s));
      for (int a = 0; a < 3; ++a) slope[s][a] = share * (F.normal[0] * K.gradient[a][0] + F.normal[1] * K.gradient[a][1]);
    }
    for (int q = 0; q < traces.t.extent_int(0); ++q) {
      const double weight = traces.weight(q) * F.length;
      const double mu_F = mu(e, q, 0) > mu(e, q, 1) ? mu(e, q, 0) : mu(e, q, 1);
      const double stiff = weight * mu_F * penalty.eta / F.length;
      double mean[2 * most], jump[2 * most];
      for (int s = 0; s < 2; ++s) {
        const LocalIndex side = faces.side(k, s);
        for (int i = 0; i < n && faces.cell(k, s) >= 0; ++i) {
          jump[s * n + i] = (s == 0 ? 1 : -1) * traces.value(side, q, i);
          mean[s * n + i] = 0;
          for (int a = 0; a < 3; ++a) mean[s * n + i] += mu(e, q, s) * slope[s][a] * traces.derivative(side, q, i, a);
        }
      }
      // the trace of most functions vanishes on the face
      for (int s = 0; s < 2; ++s)
        for (int m = 0; m < on_face && faces.cell(k, s) >= 0; ++m) {
          const int i = s * n + traces.on_face(faces.side(k, s) / 2, m);
          const double consistency = weight * jump[i];
          for (int r = 0; r < 2; ++r) {
            if (faces.cell(k, r) < 0) continue;
            for (int j = r * n; j < (r + 1) * n; ++j) {
              A(e, i, j) -= consistency * mean[j];
              A(e, j, i) -= penalty.theta * consistency * mean[j];
            }
            for (int l = 0; l < on_face; ++l) {
              const int j = r * n + traces.on_face(faces.side(k, r) / 2, l);
              A(e, i, j) += stiff * jump[i] * jump[j];
            }
          }
        }
    }
  }
};

}  // namespace

Faces faces_of(const mesh::Mesh& mesh, const View<const LocalIndex*>& face) {
  const View<LocalIndex*[2]> cell("thixis::dg::face_cells", face.extent(0)), side("thixis::dg::face_sides", face.extent(0));
  SetFaces kernel;
  kernel.vertices = mesh.cell_vertices;
  kernel.cell_faces = mesh.cell_faces;
  kernel.face_vertices = mesh.face_vertices;
  kernel.face_cells = mesh.face_cells;
  kernel.face = face;
  kernel.cell = cell;
  kernel.side = side;
  Kokkos::parallel_for("thixis::dg::faces", Kokkos::RangePolicy<>(0, face.extent_int(0)), kernel);
  return {face, cell, side};
}

void face_matrices(const mesh::Mesh& mesh, const Faces& faces, const Traces& traces, const Penalty& penalty, LocalIndex first,
                   const Tensions& mu, const Matrices& A) {
  FaceMatrices kernel;
  kernel.x = mesh.coordinates;
  kernel.vertices = mesh.cell_vertices;
  kernel.face_vertices = mesh.face_vertices;
  kernel.faces = faces;
  kernel.traces = traces;
  kernel.penalty = penalty;
  kernel.first = first;
  kernel.mu = mu;
  kernel.A = A;
  Kokkos::parallel_for("thixis::dg::face_matrices", Kokkos::RangePolicy<>(0, A.extent_int(0)), kernel);
}

}  // namespace thixis::dg
