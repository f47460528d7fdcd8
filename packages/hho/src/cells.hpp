#pragma once
#include <cmath>

#include "reference_cell.hpp"
#include "thixis/hho/params.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/space.hpp"

namespace thixis::hho {

using method::View;

constexpr int most_unknowns = reference::max_functions + 3 * reference::max_degree;  ///< 27

/// A cell with the signs of its unknowns: functions of odd degree change theirs on a face that runs from vertex f+2 to f+1.
struct Cells {
  View<double* [2]> x;
  View<LocalIndex*[3]> vertices, faces;
  View<LocalIndex* [2]> face_vertices;
  View<const LocalIndex*> cells;  ///< patch cells
  int degree, functions;
  double kappa;
  StabilizationLength length;

  KOKKOS_FUNCTION mesh::CellGeometry geometry(LocalIndex k) const { return mesh::cell_geometry(x, vertices, cells(k)); }

  KOKKOS_FUNCTION void signs(LocalIndex k, double* sign) const {
    const LocalIndex K = cells(k);
    for (int i = 0; i < functions; ++i) sign[i] = 1;
    for (int f = 0; f < 3; ++f) {
      const bool along = face_vertices(faces(K, f), 0) == vertices(K, (f + 1) % 3);
      for (int j = 0; j < degree; ++j) sign[functions + f * degree + j] = along || j % 2 == 0 ? 1 : -1;
    }
  }

  /// kappa |F|/h for each face: |F_f| = 2|K| |grad(lambda_f)|.
  KOKKOS_FUNCTION void stabilization(const mesh::CellGeometry& K, double (&weight)[3]) const {
    double longest = 0;
    for (int f = 0; f < 3; ++f) {
      weight[f] = 2 * K.area * std::sqrt(K.gradient[f][0] * K.gradient[f][0] + K.gradient[f][1] * K.gradient[f][1]);
      longest = weight[f] > longest ? weight[f] : longest;
    }
    for (int f = 0; f < 3; ++f) weight[f] = length == StabilizationLength::face ? kappa : kappa * weight[f] / longest;
  }
};

inline Cells cells_of(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const ReferenceCell& reference,
                      const method::MethodParams& params) {
  const Params& own = params.own.get<Params>();
  return {mesh.coordinates, mesh.cell_vertices,  mesh.cell_faces,   mesh.face_vertices,      cells,
          reference.degree, reference.functions, own.stabilization, own.stabilization_length};
}

}  // namespace thixis::hho
