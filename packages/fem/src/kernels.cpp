#include "kernels.hpp"

namespace thixis::fem {
namespace {

/// The triangle K by its edge vectors: edge i is opposite vertex i, so that grad(psi_i) = rotate(edge_i) / (2|K|).
struct Triangle {
  double edge[3][2];
  double area;

  KOKKOS_INLINE_FUNCTION Triangle(const mesh::View<double* [2]>& x, const mesh::View<LocalIndex* [3]>& vertices, LocalIndex K) {
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d) edge[i][d] = x(vertices(K, (i + 2) % 3), d) - x(vertices(K, (i + 1) % 3), d);
    area = 0.5 * (edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0]);
  }
  /// |K| grad(psi_i)·grad(psi_j)
  KOKKOS_INLINE_FUNCTION double product(int i, int j) const {
    return (edge[i][0] * edge[j][0] + edge[i][1] * edge[j][1]) / (4 * area);
  }
};

struct Stiffness {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  Cells cells;
  LocalIndex first;
  Block1 mu;
  Block3 A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const Triangle K(x, vertices, cells(first + e));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) A(e, i, j) = mu(e) * K.product(i, j);
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
    const Triangle K(x, vertices, cell);
    double gradient[2] = {0, 0};  // of u_h, turned by 90 degrees and times 2|K|
    for (int j = 0; j < 3; ++j)
      for (int d = 0; d < 2; ++d) gradient[d] += u(vertices(cell, j)) * K.edge[j][d];
    const double factor = mu(e) / (4 * K.area);
    for (int i = 0; i < 3; ++i) y(e, i) = factor * (gradient[0] * K.edge[i][0] + gradient[1] * K.edge[i][1]);
    energy(e) = factor * (gradient[0] * gradient[0] + gradient[1] * gradient[1]);
  }
};

struct MeanValues {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  Cells cells;
  LocalIndex first;
  Block2 d;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const Triangle K(x, vertices, cells(first + e));
    for (int i = 0; i < 3; ++i) d(e, i) = K.area / 3;
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
