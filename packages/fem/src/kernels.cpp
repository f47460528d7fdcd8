#include "kernels.hpp"

#include "thixis/mesh/geometry.hpp"

namespace thixis::fem {
namespace {

using mesh::CellGeometry;

KOKKOS_INLINE_FUNCTION double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1]; }

struct Stiffness {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  Cells cells;
  LocalIndex first;
  Block1 mu;
  Block3 A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const CellGeometry K = mesh::cell_geometry(x, vertices, cells(first + e));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) A(e, i, j) = mu(e) * K.area * dot(K.gradient[i], K.gradient[j]);
  }
};

struct Forces {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  Cells cells;
  LocalIndex first;
  Block1 mu;
  Kokkos::View<const double*> u;
  Block2 y;       ///< out, overwritten
  Block1 energy;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex cell = cells(first + e);
    const CellGeometry K = mesh::cell_geometry(x, vertices, cell);
    double gradient[2] = {0, 0};
    for (int j = 0; j < 3; ++j)
      for (int d = 0; d < 2; ++d) gradient[d] += u(vertices(cell, j)) * K.gradient[j][d];
    for (int i = 0; i < 3; ++i) y(e, i) = mu(e) * K.area * dot(gradient, K.gradient[i]);
    energy(e) = mu(e) * K.area * dot(gradient, gradient);
  }
};

struct MeanValues {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  Cells cells;
  LocalIndex first;
  Block2 d;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const double area = mesh::cell_area(x, vertices, cells(first + e));
    for (int i = 0; i < 3; ++i) d(e, i) = area / 3;
  }
};

}  // namespace

void stiffness(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block1& mu, const Block3& A) {
  Kokkos::parallel_for("thixis::fem::stiffness", A.extent_int(0),
                       Stiffness{mesh.coordinates, mesh.cell_vertices, cells, first, mu, A});
}

void forces(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block1& mu, const Kokkos::View<const double*>& u,
            const Block2& y, const Block1& energy) {
  Kokkos::parallel_for("thixis::fem::forces", y.extent_int(0),
                       Forces{mesh.coordinates, mesh.cell_vertices, cells, first, mu, u, y, energy});
}

void mean_values(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block2& d) {
  Kokkos::parallel_for("thixis::fem::mean_values", d.extent_int(0),
                       MeanValues{mesh.coordinates, mesh.cell_vertices, cells, first, d});
}

}  // namespace thixis::fem
