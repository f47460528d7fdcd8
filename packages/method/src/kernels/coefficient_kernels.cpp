#include "kernels/polynomial_kernels.hpp"

namespace thixis::method {
namespace {

struct Apply {
  LocalMatrices A;
  LocalIndex first;
  Entry entries;
  Coefficients u;
  Block2 y;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    for (int i = 0; i < A.extent_int(1); ++i) {
      double sum = 0;
      for (int j = 0; j < A.extent_int(2); ++j)
        if (entries(first + e, j) >= 0) sum += A(e, i, j) * u(entries(first + e, j));
      y(e, i) = sum;
    }
  }
};

struct Transform {
  Table T;
  int components;
  Entry entries;
  Coefficients u, out;

  KOKKOS_FUNCTION void operator()(int k) const {
    const int n = T.extent_int(0);
    for (int m = 0; m < components; ++m)
      for (int i = 0; i < n; ++i) {
        double sum = 0;
        for (int j = 0; j < n; ++j) sum += T(i, j) * u(entries(k, components * j + m));
        out(entries(k, components * i + m)) = sum;
      }
  }
};

struct InvertMass {
  Table M_inverse;
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  ElementUnknowns columns;
  Entry entries;
  Values X3;
  Coefficients lambda;

  KOKKOS_FUNCTION void operator()(int k) const {
    const int n = M_inverse.extent_int(0);
    const double scale = 1 / (2 * mesh::cell_area(x, vertices, cells(k)));
    for (int l = 0; l < n; ++l) {
      double sum = 0;
      for (int m = 0; m < n; ++m)
        if (columns(k, m) >= 0) sum += M_inverse(l, m) * X3(columns(k, m));
      lambda(entries(k, l)) = scale * sum;
    }
  }
};

struct CountCells {
  ElementUnknowns columns;
  int functions;
  View<int*> count;

  KOKKOS_FUNCTION void operator()(int k) const {
    for (int l = 0; l < functions; ++l) {
      const LocalIndex row = columns(k, l);
      if (row >= 0 && row < count.extent_int(0)) Kokkos::atomic_add(&count(row), 1);
    }
  }
};

Kokkos::RangePolicy<> range(LocalIndex count) { return Kokkos::RangePolicy<>(0, count); }

}  // namespace

void apply(const LocalMatrices& A, LocalIndex first, const Entry& entries, const Coefficients& u, const Block2& y) {
  Kokkos::parallel_for("thixis::method::apply", range(A.extent_int(0)), Apply{A, first, entries, u, y});
}

void transform(const Table& T, LocalIndex cells, int components, const Entry& entries, const Coefficients& u, const Coefficients& out) {
  Kokkos::parallel_for("thixis::method::transform", range(cells), Transform{T, components, entries, u, out});
}

void invert_mass(const Table& M_inverse, const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, LocalIndex count,
                 const ElementUnknowns& columns, const Entry& entries, const Values& X3, const Coefficients& lambda) {
  InvertMass kernel;
  kernel.M_inverse = M_inverse;
  kernel.x = mesh.coordinates;
  kernel.vertices = mesh.cell_vertices;
  kernel.cells = cells;
  kernel.columns = columns;
  kernel.entries = entries;
  kernel.X3 = X3;
  kernel.lambda = lambda;
  Kokkos::parallel_for("thixis::method::invert_mass", range(count), kernel);
}

void count_cells(const ElementUnknowns& columns, int functions, const View<int*>& count) {
  Kokkos::parallel_for("thixis::method::count_cells", range(columns.extent_int(0)), CountCells{columns, functions, count});
}

}  // namespace thixis::method
