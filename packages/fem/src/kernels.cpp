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

/// psi_i at the reference point xi
KOKKOS_INLINE_FUNCTION double psi(int i, double xi0, double xi1) { return i == 0 ? 1 - xi0 - xi1 : i == 1 ? xi0 : xi1; }

struct Loads {
  method::QuadratureBlock block;
  Kokkos::View<const double*> f;
  Block2 F;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    double sum[3] = {0, 0, 0};
    for (int q = block.offset(e); q < block.offset(e + 1); ++q)
      for (int i = 0; i < 3; ++i) sum[i] += block.weight(q) * f(q) * psi(i, block.xi(q, 0), block.xi(q, 1));
    for (int i = 0; i < 3; ++i) F(e, i) = sum[i];
  }
};

struct Means {
  method::QuadratureBlock block;
  Kokkos::View<const double*> f;
  Block1 mean;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    double sum = 0, area = 0;
    for (int q = block.offset(e); q < block.offset(e + 1); ++q) {
      sum += block.weight(q) * f(q);
      area += block.weight(q);
    }
    mean(e) = sum / area;
  }
};

struct GradientError {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  method::QuadratureBlock block;
  KnownGradient exact;
  Kokkos::View<const double*> u;

  KOKKOS_FUNCTION void operator()(int e, double& sum) const {
    const LocalIndex cell = block.cell(e);
    const CellGeometry K = mesh::cell_geometry(x, vertices, cell);
    double gradient[2] = {0, 0};
    for (int j = 0; j < 3; ++j)
      for (int d = 0; d < 2; ++d) gradient[d] += u(vertices(cell, j)) * K.gradient[j][d];
    for (int q = block.offset(e); q < block.offset(e + 1); ++q) {
      const double error[2] = {exact.x(q) - gradient[0], exact.y(q) - gradient[1]};
      sum += block.weight(q) * exact.mu(q) * dot(error, error);
    }
  }
};

}  // namespace

void loads(const method::QuadratureBlock& block, const Kokkos::View<const double*>& f, const Block2& F) {
  Kokkos::parallel_for("thixis::fem::loads", block.cells, Loads{block, f, F});
}

void means(const method::QuadratureBlock& block, const Kokkos::View<const double*>& f, const Block1& mean) {
  Kokkos::parallel_for("thixis::fem::means", block.cells, Means{block, f, mean});
}

double gradient_error(const mesh::Mesh& mesh, const method::QuadratureBlock& block, LocalIndex cells, const KnownGradient& exact,
                      const Kokkos::View<const double*>& u) {
  double sum = 0;
  Kokkos::parallel_reduce("thixis::fem::gradient_error", cells, GradientError{mesh.coordinates, mesh.cell_vertices, block, exact, u}, sum);
  return sum;
}

void stiffness(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block1& mu, const Block3& A) {
  Kokkos::parallel_for("thixis::fem::stiffness", A.extent_int(0), Stiffness{mesh.coordinates, mesh.cell_vertices, cells, first, mu, A});
}

void forces(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block1& mu, const Kokkos::View<const double*>& u,
            const Block2& y, const Block1& energy) {
  Kokkos::parallel_for("thixis::fem::forces", y.extent_int(0),
                       Forces{mesh.coordinates, mesh.cell_vertices, cells, first, mu, u, y, energy});
}

void mean_values(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block2& d) {
  Kokkos::parallel_for("thixis::fem::mean_values", d.extent_int(0), MeanValues{mesh.coordinates, mesh.cell_vertices, cells, first, d});
}

}  // namespace thixis::fem
