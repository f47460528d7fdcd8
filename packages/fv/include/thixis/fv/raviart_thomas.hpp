#pragma once
#include "thixis/fv/grid.hpp"

namespace thixis::fv {

/// The polynomial value + at·(x - x_K) + ½ sum_i slope_i (x - x_K)_i², and its gradient at + slope (x - x_K), a field of RT_0: on
/// triangles slope_0 = slope_1.
struct Quadratic {
  double value = 0, at[2] = {0, 0}, slope[2] = {0, 0};

  /// At x_K + y.
  KOKKOS_INLINE_FUNCTION double operator()(const double y[2]) const {
    return value + (at[0] + 0.5 * slope[0] * y[0]) * y[0] + (at[1] + 0.5 * slope[1] * y[1]) * y[1];
  }
};

/// The fields of RT_0 on the owned cells of a grid (docs/methods/two_phase_estimates.md, 3). v is given by g_f, the value of v·n on the
/// f-th face of the cell, n outward, in the order of Grid::cell_faces: then div v = sum_f |F| g_f/|K|.
struct RaviartThomas {
  static constexpr int most_faces = 4;

  View<const LocalIndex*> begin, faces;
  View<const LocalIndex* [2]> face_cells;
  View<const double*> area, volume;
  View<const double*[2]> centre, barycentre, face_centre, normal;
  bool triangles;

  explicit RaviartThomas(const Grid& grid)
      : begin(grid.cell_face_begin),
        faces(grid.cell_faces),
        face_cells(grid.face_cells),
        area(grid.face_area),
        volume(grid.volume),
        centre(grid.centre),
        barycentre(grid.barycentre),
        face_centre(grid.face_centre),
        normal(grid.face_normal),
        triangles(grid.corners() == 3) {}

  KOKKOS_INLINE_FUNCTION int count(LocalIndex K) const { return begin(K + 1) - begin(K); }
  KOKKOS_INLINE_FUNCTION LocalIndex face(LocalIndex K, int f) const { return faces(begin(K) + f); }
  /// 1 where the normal of the grid is the outward one, else -1.
  KOKKOS_INLINE_FUNCTION double sign(LocalIndex K, int f) const { return face_cells(face(K, f), 0) == K ? 1 : -1; }
  /// The cell behind the face, -1 on the boundary.
  KOKKOS_INLINE_FUNCTION LocalIndex neighbour(LocalIndex K, int f) const {
    return face_cells(face(K, f), 0) == K ? face_cells(face(K, f), 1) : face_cells(face(K, f), 0);
  }
  /// The coordinate direction of the normal, on intervals and rectangles.
  KOKKOS_INLINE_FUNCTION int axis(LocalIndex F) const { return normal(F, 0) * normal(F, 0) > 0.5 ? 0 : 1; }

  KOKKOS_INLINE_FUNCTION double divergence(LocalIndex K, const double* g) const {
    double sum = 0;
    for (int f = 0; f < count(K); ++f) sum += area(face(K, f)) * g[f];
    return sum / volume(K);
  }

  /// p with this value at x_K and grad p = v.
  KOKKOS_INLINE_FUNCTION Quadratic potential(LocalIndex K, double value, const double* g) const {
    Quadratic p;
    p.value = value;
    for (int f = 0; f < count(K); ++f) {
      const LocalIndex F = face(K, f);
      if (triangles) {
        const double c = area(F) * g[f] / (2 * volume(K));
        for (int i = 0; i < 2; ++i) {
          const double opposite = 3 * barycentre(K, i) - 2 * face_centre(F, i);
          p.at[i] += c * (centre(K, i) - opposite);
          p.slope[i] += c;
        }
      } else {
        const int i = axis(F);
        p.at[i] += 0.5 * sign(K, f) * normal(F, i) * g[f];
        p.slope[i] += area(F) * g[f] / volume(K);
      }
    }
    return p;
  }

  /// |v|_K²
  KOKKOS_INLINE_FUNCTION double square(LocalIndex K, const double* g) const {
    const Quadratic p = potential(K, 0, g);
    double sum = 0;
    if (triangles) {  // midpoints of the faces: exact for degree 2
      for (int f = 0; f < count(K); ++f)
        for (int i = 0; i < 2; ++i) {
          const double v = p.at[i] + p.slope[i] * (face_centre(face(K, f), i) - centre(K, i));
          sum += v * v / 3;
        }
    } else {
      double both[2] = {0, 0};  // slope times width of the cell
      for (int f = 0; f < count(K); ++f) both[axis(face(K, f))] += g[f];
      for (int i = 0; i < 2; ++i) sum += p.at[i] * p.at[i] + both[i] * both[i] / 12;
    }
    return volume(K) * sum;
  }
};

}  // namespace thixis::fv
