#include "face_form.hpp"

#include <array>

#include "thixis/reference/quadrature.hpp"

namespace thixis::dg {
namespace {

constexpr int most = reference::max_functions;

struct FaceMatrices {
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<LocalIndex* [2]> face_vertices;
  Faces faces;
  Traces traces;
  Penalty penalty;
  LocalIndex first;
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

Traces traces(const reference::CellBasis& basis, int order) {
  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const auto rule = reference::line_quadrature(order);
  const int n = basis.size(), points = rule.size(), p = basis.degree();
  View<double*> t("thixis::dg::points", points), weight("thixis::dg::weights", points);
  Kokkos::View<double***, Kokkos::LayoutRight> value("thixis::dg::traces", 6, points, n);
  Kokkos::View<double*** [3], Kokkos::LayoutRight> derivative("thixis::dg::trace_derivatives", 6, points, n);
  Kokkos::View<int**, Kokkos::LayoutRight> on_face("thixis::dg::on_face", 3, p + 1);
  const auto t_host = Kokkos::create_mirror_view(t), weight_host = Kokkos::create_mirror_view(weight);
  const auto value_host = Kokkos::create_mirror_view(value);
  const auto derivative_host = Kokkos::create_mirror_view(derivative);
  const auto on_host = Kokkos::create_mirror_view(on_face);
  for (int q = 0; q < points; ++q) {
    t_host(q) = rule.point[q];
    weight_host(q) = rule.weight[q];
  }
  for (int f = 0; f < 3; ++f) {
    for (int back = 0; back < 2; ++back)
      for (int q = 0; q < points; ++q) {
        const double s = back ? 1 - rule.point[q] : rule.point[q];
        double at[2], B[most], dB[most][3];
        for (int d = 0; d < 2; ++d) at[d] = (1 - s) * corner[(f + 1) % 3][d] + s * corner[(f + 2) % 3][d];
        const double lambda[3] = {1 - at[0] - at[1], at[0], at[1]};
        basis.bernstein().values(lambda, B);
        basis.bernstein().derivatives(lambda, dB);
        for (int i = 0; i < n; ++i)
          for (int k = 0; k < n; ++k) {
            const double c = basis.to_bernstein()[k * n + i];
            value_host(2 * f + back, q, i) += c * B[k];
            for (int a = 0; a < 3; ++a) derivative_host(2 * f + back, q, i, a) += c * dB[k][a];
          }
      }
    int count = 0;
    for (int i = 0; i < n; ++i) {
      const auto& entity = basis.entities()[i];
      const bool end = entity.kind == reference::Entity::vertex && entity.index != f;
      if (end || (entity.kind == reference::Entity::face && entity.index == f)) on_host(f, count++) = i;
    }
  }
  Kokkos::deep_copy(t, t_host);
  Kokkos::deep_copy(weight, weight_host);
  Kokkos::deep_copy(value, value_host);
  Kokkos::deep_copy(derivative, derivative_host);
  Kokkos::deep_copy(on_face, on_host);
  return {t, weight, value, derivative, on_face};
}

void face_matrices(const mesh::Mesh& mesh, const Faces& faces, const Traces& traces, const Penalty& penalty, LocalIndex first,
                   const Tensions& mu, const Matrices& A) {
  Kokkos::parallel_for("thixis::dg::face_matrices", Kokkos::RangePolicy<>(0, A.extent_int(0)),
                       FaceMatrices{mesh.coordinates, mesh.cell_vertices, mesh.face_vertices, faces, traces, penalty, first, mu, A});
}

}  // namespace thixis::dg
