#pragma once
#include <Kokkos_Core.hpp>
#include <cmath>

#include "thixis/core/types.hpp"
#include "thixis/mesh/mesh.hpp"

/// Geometry of straight triangles, for kernels. The Views are those of a Mesh or their host mirrors.
namespace thixis::mesh {

/// A triangle K with vertices x_0, x_1, x_2 counter-clockwise.
struct CellGeometry {
  double area;            ///< |K|
  double gradient[3][2];  ///< grad(lambda_i) of the barycentric coordinates: -(outward normal of face i) |F_i| / (2|K|)
};

/// A face with end vertices a (lower id) and b.
struct FaceGeometry {
  double length;       ///< |b - a|
  double normal[2];    ///< unit normal: (b - a)/|b - a| turned by -90 degrees
  double midpoint[2];  ///< (a + b)/2
};

/// |K| = (x_1 - x_0) x (x_2 - x_0) / 2; negative if the vertices run clockwise.
template <class Coordinates, class CellVertices>
KOKKOS_INLINE_FUNCTION double cell_area(const Coordinates& x, const CellVertices& cell_vertices, LocalIndex K) {
  const LocalIndex a = cell_vertices(K, 0), b = cell_vertices(K, 1), c = cell_vertices(K, 2);
  return 0.5 * ((x(b, 0) - x(a, 0)) * (x(c, 1) - x(a, 1)) - (x(c, 0) - x(a, 0)) * (x(b, 1) - x(a, 1)));
}

template <class Coordinates, class CellVertices>
KOKKOS_INLINE_FUNCTION CellGeometry cell_geometry(const Coordinates& x, const CellVertices& cell_vertices, LocalIndex K) {
  CellGeometry cell;
  cell.area = cell_area(x, cell_vertices, K);
  for (int i = 0; i < 3; ++i) {
    const LocalIndex a = cell_vertices(K, (i + 1) % 3), b = cell_vertices(K, (i + 2) % 3);
    cell.gradient[i][0] = (x(a, 1) - x(b, 1)) / (2 * cell.area);
    cell.gradient[i][1] = (x(b, 0) - x(a, 0)) / (2 * cell.area);
  }
  return cell;
}

template <class Coordinates, class FaceVertices>
KOKKOS_INLINE_FUNCTION FaceGeometry face_geometry(const Coordinates& x, const FaceVertices& face_vertices, LocalIndex F) {
  const LocalIndex a = face_vertices(F, 0), b = face_vertices(F, 1);
  const double tx = x(b, 0) - x(a, 0), ty = x(b, 1) - x(a, 1);
  FaceGeometry face;
  face.length = std::sqrt(tx * tx + ty * ty);
  face.normal[0] = ty / face.length;
  face.normal[1] = -tx / face.length;
  face.midpoint[0] = 0.5 * (x(a, 0) + x(b, 0));
  face.midpoint[1] = 0.5 * (x(a, 1) + x(b, 1));
  return face;
}

/// +1 where the normal of F points out of its cell K, -1 where it points into it.
template <class FaceCells>
KOKKOS_INLINE_FUNCTION int normal_sign(const FaceCells& face_cells, LocalIndex F, LocalIndex K) {
  return face_cells(F, 0) == K ? 1 : -1;
}

/// The cell of F that is on this rank: of the two the one whose outward normal is the face normal. The only one for a face of the boundary.
template <class FaceCells>
KOKKOS_INLINE_FUNCTION LocalIndex first_cell(const FaceCells& face_cells, LocalIndex F) {
  return face_cells(F, 0) >= 0 ? face_cells(F, 0) : face_cells(F, 1);
}

/// The cell across the face F of K; -1 on the boundary and at the end of the ghost layer.
template <class FaceCells>
KOKKOS_INLINE_FUNCTION LocalIndex neighbour(const FaceCells& face_cells, LocalIndex F, LocalIndex K) {
  return face_cells(F, 0) == K ? face_cells(F, 1) : face_cells(F, 0);
}

/// The number i of the face F in its cell K: F = cell_faces(K, i).
template <class CellFaces>
KOKKOS_INLINE_FUNCTION int local_face(const CellFaces& cell_faces, LocalIndex K, LocalIndex F) {
  return cell_faces(K, 0) == F ? 0 : cell_faces(K, 1) == F ? 1 : 2;
}

/// A point of the plane.
struct Point {
  double x, y;
};

/// The physical point of a point of the parameter domain.
///
/// Disk: the hexagon with corners e_s = (cos 60s°, sin 60s°) to the unit disk. A point a e_s + b e_{s+1}, a, b >= 0, has the
/// hexagonal norm a + b, which becomes the radius, and lies at the fraction b/(a + b) of its side, which becomes that of 60°.
KOKKOS_INLINE_FUNCTION Point physical(Chart chart, Point p) {
  if (chart == Chart::identity) return p;
  const double pi = 3.14159265358979323846, root = 1.7320508075688772935;
  // Coordinates in the basis e_0, e_1; each sector is turned onto the first one: e_s -> e_{s-1} takes (a, b) to (a + b, -a).
  double a = p.x - p.y / root, b = 2 * p.y / root;
  int sector = 0;
  while ((a < 0 || b < 0) && sector < 5) {
    const double turned = a + b;
    b = -a;
    a = turned;
    ++sector;
  }
  const double radius = a + b;
  if (!(radius > 0)) return {0, 0};
  const double angle = (sector + b / radius) * (pi / 3);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace thixis::mesh
