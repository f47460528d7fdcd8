#include "flux.hpp"

#include "thixis/method/cell_functions.hpp"
#include "thixis/reference/flux_moments.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::dg {
namespace {

constexpr int most_legendre = reference::max_degree + 1;

struct Sigma {
  View<double* [2]> x;
  View<LocalIndex*[3]> vertices, faces;
  View<LocalIndex*[2]> face_vertices, face_cells;
  View<LocalIndex*> face_tag;
  FluxTables tables;
  double theta;
  method::FluxDensity density;
  ElementEntries entries;
  Kokkos::View<const double*> u;
  FaceMoments moments;
  View<double**> sigma;  ///< out, overwritten

  static constexpr int most_data = 3 * most_legendre + 2 * method::FluxDensity::most;

  KOKKOS_FUNCTION void operator()(int k) const {
    const LocalIndex K = density.quadrature.cell(k);
    const mesh::CellGeometry geometry = mesh::cell_geometry(x, vertices, K);
    const int n = entries.extent_int(1), m = density.size(), on_faces = 3 * moments.flux.extent_int(1);
    double c[reference::max_functions], g[2][method::FluxDensity::most], P[2][method::FluxDensity::most], data[most_data];
    for (int i = 0; i < n; ++i) c[i] = u(entries(k, i));
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < m; ++l) {
        g[d][l] = 0;
        for (int i = 0; i < n; ++i) g[d][l] += tables.gradient(d * m + l, i) * c[i];
      }
    density(k, geometry, g, P);
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < m; ++l) data[on_faces + d * m + l] = -P[d][l];
    for (int f = 0; f < 3; ++f) face(K, geometry, f, data);
    for (int r = 0; r < tables.from_moments.extent_int(0); ++r) {
      double sum = 0;
      for (int i = 0; i < on_faces + 2 * m; ++i) sum += tables.from_moments(r, i) * data[i];
      sigma(k, r) = sum;
    }
  }

  /// As DF^T takes v in P_{p-1}(K)² to its reference components, v = sum_d v̂_d grad(lambda_d+1).
  KOKKOS_FUNCTION void face(LocalIndex K, const mesh::CellGeometry& geometry, int f, double* data) const {
    const LocalIndex F = faces(K, f);
    const int p = moments.flux.extent_int(1) - 1, m = density.size(), side = face_cells(F, 0) == K ? 0 : 1;
    const mesh::FaceGeometry on_F = mesh::face_geometry(x, face_vertices, F);
    double slip[most_legendre];
    for (int j = 0; j <= p; ++j) {
      const double sign = side == 0 || j % 2 == 0 ? 1 : -1;
      data[f * (p + 1) + j] = (side == 0 ? sign : -sign) * on_F.length * moments.flux(F, j);
      if (j < p) slip[j] = sign * moments.slip(F, side, j);
    }
    const double share = theta * on_F.length * (face_tag(F) < 0 ? 0.5 : 1.0);
    for (int d = 0; d < 2; ++d) {
      const double* const slope = geometry.gradient[d + 1];
      const double factor = share * (on_F.normal[0] * slope[0] + on_F.normal[1] * slope[1]);
      for (int l = 0; l < m; ++l) {
        double sum = 0;
        for (int j = 0; j < p; ++j) sum += tables.trace(f * p + j, l) * slip[j];
        data[3 * (p + 1) + d * m + l] += factor * sum;
      }
    }
  }
};

}  // namespace

FluxTables flux_tables(const reference::CellBasis& basis) {
  const int n = basis.size(), p = basis.degree(), m = reference::dimension(p - 1);
  const reference::Modal modal(p - 1);
  const auto rule = reference::triangle_quadrature(2 * p);
  const auto table = basis.tabulate(rule.size(), rule.point.data());
  const auto phi = modal.values(rule.size(), rule.point.data());
  std::vector<double> gradient(2 * m * n, 0.0), trace;
  for (int q = 0; q < rule.size(); ++q)
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < m; ++l)
        for (int i = 0; i < n; ++i) gradient[(d * m + l) * n + i] += rule.weight[q] * phi[q * m + l] * table.gradient[2 * (q * n + i) + d];
  for (int f = 0; f < 3; ++f) {
    const auto of_face = modal.trace(f, p);
    trace.insert(trace.end(), of_face.begin(), of_face.end());
  }
  const reference::RaviartThomas fields(p);
  const auto T = reference::from_moments(fields);
  return {method::matrix_view("thixis::dg::modal_gradients", 2 * m, n, gradient),
          method::matrix_view("thixis::dg::modal_traces", 3 * p, m, trace),
          method::matrix_view("thixis::dg::from_moments", fields.flux_size(), static_cast<int>(T.size()) / fields.flux_size(), T)};
}

void native_flux(const mesh::Mesh& mesh, const FluxTables& tables, double theta, const method::FluxDensity& density,
                 const ElementEntries& entries, const Kokkos::View<const double*>& u, const FaceMoments& faces, LocalIndex owned,
                 const View<double**>& sigma) {
  Sigma kernel;
  kernel.x = mesh.coordinates;
  kernel.vertices = mesh.cell_vertices;
  kernel.faces = mesh.cell_faces;
  kernel.face_vertices = mesh.face_vertices;
  kernel.face_cells = mesh.face_cells;
  kernel.face_tag = mesh.face_tag;
  kernel.tables = tables;
  kernel.theta = theta;
  kernel.density = density;
  kernel.entries = entries;
  kernel.u = u;
  kernel.moments = faces;
  kernel.sigma = sigma;
  Kokkos::parallel_for("thixis::dg::native_flux", Kokkos::RangePolicy<>(0, owned), kernel);
}

}  // namespace thixis::dg
