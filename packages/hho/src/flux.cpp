#include "flux.hpp"

#include "cells.hpp"
#include "thixis/method/cell_functions.hpp"
#include "thixis/reference/flux_moments.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::hho {
namespace {

/// Data of each patch cell for FluxTables::from_moments, of its own: |F| Phi_KF of its faces from vertex f+1 to f+2, then -P.
struct OwnMoments {
  Cells cells;
  method::FluxDensity density;
  Table differences, trace;
  ElementEntries entries;
  View<const double*> u;
  int inside;    ///< dim P_{p-2}
  Moments data;  ///< out, overwritten: (k, 3p + 2 dim P_{p-2})

  KOKKOS_FUNCTION void operator()(int k) const {
    const mesh::CellGeometry K = cells.geometry(k);
    const int unknowns = entries.extent_int(1), p = cells.degree, m = density.size();
    double v[most_unknowns], weight[3], g[2][method::FluxDensity::most], P[2][method::FluxDensity::most];
    cells.signs(k, v);
    cells.stabilization(K, weight);
    for (int i = 0; i < unknowns; ++i) v[i] *= u(entries(k, i));
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < m; ++l) g[d][l] = row_times(d * m + l, v);
    const double mean = density(k, K, g, P);
    for (int f = 0; f < 3; ++f)
      for (int j = 0; j < p; ++j) {
        double phi = weight[f] * mean * row_times(2 * m + f * p + j, v);
        for (int l = 0; l < m; ++l)
          phi -= trace(f * p + j, l) * (reference::face_normal[f][0] * P[0][l] + reference::face_normal[f][1] * P[1][l]);
        data(k, f * p + j) = phi;
      }
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < inside; ++l) data(k, 3 * p + d * inside + l) = -P[d][l];
  }

  KOKKOS_FUNCTION double row_times(int row, const double* v) const {
    double sum = 0;
    for (int i = 0; i < differences.extent_int(1); ++i) sum += differences(row, i) * v[i];
    return sum;
  }
};

/// sigma from the moments of the cell and, on faces, those of its neighbours, which run backwards there.
struct Sigma {
  Cells cells;
  FaceData faces;
  Table from_moments;
  Kokkos::View<const double**, Kokkos::LayoutRight> data;
  View<const LocalIndex* [3]> cell_faces;
  View<const LocalIndex* [2]> face_cells;
  View<double**> sigma;  ///< out, overwritten

  static constexpr int most_data = 3 * 4 + 2 * 6;  // p = 4

  KOKKOS_FUNCTION void operator()(int k) const {
    const int p = cells.degree, count = from_moments.extent_int(1);
    double moment[most_data];
    for (int i = 0; i < count; ++i) moment[i] = data(k, i);
    for (int f = 0; f < 3; ++f) {
      const LocalIndex row = faces.row(k, f);
      if (row == face_inside) average(k, f, moment + f * p);
      else if (row >= 0) pull(k, f, moment + f * p);
    }
    for (int r = 0; r < from_moments.extent_int(0); ++r) {
      double sum = 0;
      for (int i = 0; i < count; ++i) sum += from_moments(r, i) * moment[i];
      sigma(k, r) = sum;
    }
  }

  KOKKOS_FUNCTION void average(int k, int f, double* moment) const {
    const LocalIndex other = faces.neighbour(k, f);
    const int g = mesh::local_face(cell_faces, cells.cells(other), cell_faces(cells.cells(k), f));
    for (int j = 0; j < cells.degree; ++j) moment[j] = 0.5 * (moment[j] - (j % 2 == 0 ? 1 : -1) * data(other, g * cells.degree + j));
  }

  KOKKOS_FUNCTION void pull(int k, int f, double* moment) const {
    const LocalIndex K = cells.cells(k), F = cell_faces(K, f);
    const bool along = mesh::normal_sign(face_cells, F, K) > 0;
    const double length = mesh::face_geometry(cells.x, cells.face_vertices, F).length;
    for (int j = 0; j < cells.degree; ++j) moment[j] = (along || j % 2 == 0 ? -length : length) * faces.traction(faces.row(k, f), j);
  }
};

struct Share {
  Cells cells;
  Table R_f;  ///< (f p + j, l): ∫ of psi_l L_j over face f
  View<const LocalIndex*> face_tag;
  ElementEntries entries;
  View<const double*> R;
  View<double**> moments;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int k) const {
    const int n = cells.functions, p = cells.degree;
    double sign[most_unknowns];
    cells.signs(k, sign);
    for (int l = 0; l < n; ++l) {
      double sum = R(entries(k, l));
      for (int f = 0; f < 3; ++f) {
        const double part = face_tag(cells.faces(cells.cells(k), f)) < 0 ? 0.5 : 1.0;
        for (int j = 0; j < p; ++j) sum += part * sign[n + f * p + j] * R(entries(k, n + f * p + j)) * R_f(f * p + j, l);
      }
      moments(k, l) = sum;
    }
  }
};

}  // namespace

FluxTables flux_tables(const ReferenceCell& reference) {
  const int p = reference.degree, m = reference.B.size, unknowns = reference.unknowns, q = p - 1;
  const auto C = reference::inverse(m, reference::modal_to_bernstein(reference.B));
  const reference::Modal modal(q);
  std::vector<double> differences((2 * m + 3 * p) * unknowns, 0.0), trace;
  for (int d = 0; d < 2; ++d)
    for (int l = 0; l < m; ++l)
      for (int k = 0; k < m; ++k)
        for (int i = 0; i < unknowns; ++i)
          differences[(d * m + l) * unknowns + i] +=
              C[l * m + k] * (reference.G[d + 1][k * unknowns + i] - reference.G[0][k * unknowns + i]);
  for (int f = 0; f < 3; ++f) {
    std::copy(reference.R[f].begin(), reference.R[f].end(), differences.begin() + (2 * m + f * p) * unknowns);
    const auto of_face = modal.trace(f, p);
    trace.insert(trace.end(), of_face.begin(), of_face.end());
  }
  const reference::RaviartThomas fields(q);
  const auto T = reference::from_moments(fields);
  return {method::matrix_view("thixis::hho::differences", 2 * m + 3 * p, unknowns, differences),
          method::matrix_view("thixis::hho::modal_traces", 3 * p, m, trace),
          method::matrix_view("thixis::hho::from_moments", fields.flux_size(), static_cast<int>(T.size()) / fields.flux_size(), T)};
}

void native_flux(const mesh::Mesh& mesh, const ReferenceCell& reference, const FluxTables& tables, const method::MethodParams& params,
                 const method::FluxDensity& density, const FaceData& faces, const ElementEntries& entries, const method::Coefficients& u,
                 LocalIndex owned, const View<double**>& sigma) {
  const Cells cells = cells_of(mesh, density.quadrature.cell, reference, params);
  const int p = reference.degree, count = tables.from_moments.extent_int(1);
  const Moments data("thixis::hho::flux_moments", entries.extent(0), count);
  OwnMoments own;
  own.cells = cells;
  own.density = density;
  own.differences = tables.differences;
  own.trace = tables.trace;
  own.entries = entries;
  own.u = u;
  own.inside = (count - 3 * p) / 2;
  own.data = data;
  Kokkos::parallel_for("thixis::hho::flux_moments", Kokkos::RangePolicy<>(0, entries.extent_int(0)), own);
  Sigma kernel;
  kernel.cells = cells;
  kernel.faces = faces;
  kernel.from_moments = tables.from_moments;
  kernel.data = data;
  kernel.cell_faces = mesh.cell_faces;
  kernel.face_cells = mesh.face_cells;
  kernel.sigma = sigma;
  Kokkos::parallel_for("thixis::hho::native_flux", Kokkos::RangePolicy<>(0, owned), kernel);
}

void share(const mesh::Mesh& mesh, const ReferenceCell& reference, const method::MethodParams& params, const View<const LocalIndex*>& cells,
           const ElementEntries& entries, const method::Coefficients& R, const View<double**>& moments) {
  const int n = reference.functions, p = reference.degree;
  std::vector<double> traces(3 * p * n);
  for (int f = 0; f < 3; ++f)
    for (int j = 0; j < p; ++j)
      for (int l = 0; l < n; ++l) traces[(f * p + j) * n + l] = reference.R[f][j * reference.unknowns + l];
  Kokkos::parallel_for("thixis::hho::share", Kokkos::RangePolicy<>(0, entries.extent_int(0)),
                       Share{cells_of(mesh, cells, reference, params), method::matrix_view("thixis::hho::traces", 3 * p, n, traces),
                             mesh.face_tag, entries, R, moments});
}

}  // namespace thixis::hho
