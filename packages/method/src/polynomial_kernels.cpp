#include "polynomial_kernels.hpp"

namespace thixis::method {
namespace {

constexpr int most = reference::max_functions;

struct Moments {
  CellFunctions functions;
  QuadratureBlock block;
  Values f;
  Block2 F;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const int n = functions.size();
    double B[most], sum[most] = {};
    for (int q = block.offset(e); q < block.offset(e + 1); ++q) {
      const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
      functions.B.values(lambda, B);
      const double wf = block.weight(q) * f(q);
      for (int k = 0; k < n; ++k) sum[k] += wf * B[k];
    }
    for (int l = 0; l < n; ++l) F(e, l) = functions.moment(sum, l);
  }
};

struct GradientError {
  CellFunctions functions;
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  QuadratureBlock block;
  AtPoints known;
  Entry entries;
  Coefficients u;

  KOKKOS_FUNCTION void operator()(int e, double& sum) const {
    const int n = functions.size();
    const mesh::CellGeometry K = mesh::cell_geometry(x, vertices, block.cell(e));
    double local[most], c[most];
    for (int l = 0; l < n; ++l) local[l] = u(entries(block.first + e, l));
    functions.to_bernstein(local, c);
    const bool compared = known.x.extent(0) > 0;
    for (int q = block.offset(e); q < block.offset(e + 1); ++q) {
      const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
      double slope[3], gradient[2] = {0, 0};
      functions.B.gradient(c, lambda, slope);
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) gradient[d] += slope[a] * K.gradient[a][d];
      const double dx = gradient[0] - (compared ? known.x(q) : 0), dy = gradient[1] - (compared ? known.y(q) : 0);
      sum += block.weight(q) * known.mu(q) * (dx * dx + dy * dy);
    }
  }
};

struct ValueError {
  CellFunctions functions;
  QuadratureBlock block;
  Values known;
  Entry entries;
  Coefficients u;

  KOKKOS_FUNCTION void operator()(int e, double& sum) const {
    const int n = functions.size();
    double local[most], c[most], B[most];
    for (int l = 0; l < n; ++l) local[l] = u(entries(block.first + e, l));
    functions.to_bernstein(local, c);
    for (int q = block.offset(e); q < block.offset(e + 1); ++q) {
      const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
      functions.B.values(lambda, B);
      double difference = known(q);
      for (int k = 0; k < n; ++k) difference -= c[k] * B[k];
      sum += block.weight(q) * difference * difference;
    }
  }
};

struct Apply {
  LocalMatrices A;
  LocalIndex first;
  Entry entries;
  Coefficients u;
  Block2 y;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    for (int i = 0; i < A.extent_int(1); ++i) {
      double sum = 0;
      for (int j = 0; j < A.extent_int(2); ++j) sum += A(e, i, j) * u(entries(first + e, j));
      y(e, i) = sum;
    }
  }
};

struct Transform {
  Table T;
  Entry entries;
  Coefficients u, out;

  KOKKOS_FUNCTION void operator()(int k) const {
    const int n = T.extent_int(0);
    for (int i = 0; i < n; ++i) {
      double sum = 0;
      for (int j = 0; j < n; ++j) sum += T(i, j) * u(entries(k, j));
      out(entries(k, i)) = sum;
    }
  }
};

struct RestrictToChildren {
  Children children;
  Block2 coarse, fine;

  KOKKOS_FUNCTION void operator()(int k) const {
    const int n = fine.extent_int(1);
    const LocalIndex c = children.child(k), K = children.parent(k);
    for (int i = 0; i < n; ++i) {
      double sum = 0;
      for (int j = 0; j < n; ++j) sum += children.T(c, i, j) * coarse(K, j);
      fine(k, i) = sum;
    }
  }
};

struct MomentsOf {
  Table M;
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  LocalIndex first;
  Block2 u, F;

  KOKKOS_FUNCTION void operator()(int e) const {
    const int n = M.extent_int(0);
    const double scale = 2 * mesh::cell_area(x, vertices, cells(first + e));
    for (int l = 0; l < n; ++l) {
      double sum = 0;
      for (int m = 0; m < n; ++m) sum += M(l, m) * u(first + e, m);
      F(e, l) = scale * sum;
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

struct Deepest {
  CellFunctions functions;
  LocalIndex first;
  Table lambda;
  Block2 obstacle;
  Entry entries;
  Coefficients u;

  KOKKOS_FUNCTION void operator()(int e, double& deepest) const {
    const int n = functions.size();
    double local[most], c[most];
    for (int l = 0; l < n; ++l) local[l] = u(entries(first + e, l));
    functions.to_bernstein(local, c);
    const bool over_zero = obstacle.extent(0) == 0;
    if (over_zero) {  // nothing to look for where no coefficient is negative
      double least = 0;
      for (int k = 0; k < n; ++k) least = c[k] < least ? c[k] : least;
      if (least >= 0 || -least <= deepest) return;
    }
    for (int q = 0; q < lambda.extent_int(0); ++q) {
      const double at[3] = {lambda(q, 0), lambda(q, 1), lambda(q, 2)};
      const double depth = (over_zero ? 0 : obstacle(e, q)) - functions.B.value(c, at);
      if (deepest < depth) deepest = depth;
    }
  }
};

Kokkos::RangePolicy<> range(LocalIndex count) { return Kokkos::RangePolicy<>(0, count); }

}  // namespace

void moments(const CellFunctions& functions, const QuadratureBlock& block, const Values& f, const Block2& F) {
  Kokkos::parallel_for("thixis::method::moments", range(block.cells), Moments{functions, block, f, F});
}

double value_error(const CellFunctions& functions, const QuadratureBlock& block, LocalIndex cells, const Values& known,
                   const Entry& entries, const Coefficients& u) {
  double sum = 0;
  Kokkos::parallel_reduce("thixis::method::value_error", Kokkos::RangePolicy<>(0, cells), ValueError{functions, block, known, entries, u},
                          sum);
  return sum;
}

double gradient_error(const CellFunctions& functions, const mesh::Mesh& mesh, const QuadratureBlock& block, LocalIndex cells,
                      const AtPoints& known, const Entry& entries, const Coefficients& u) {
  double sum = 0;
  Kokkos::parallel_reduce("thixis::method::gradient_error", range(cells),
                          GradientError{functions, mesh.coordinates, mesh.cell_vertices, block, known, entries, u}, sum);
  return sum;
}

void apply(const LocalMatrices& A, LocalIndex first, const Entry& entries, const Coefficients& u, const Block2& y) {
  Kokkos::parallel_for("thixis::method::apply", range(A.extent_int(0)), Apply{A, first, entries, u, y});
}

void gather(const Entry& entries, int functions, const Coefficients& u, const Block2& of_cells) {
  Kokkos::parallel_for(
      "thixis::method::gather", Kokkos::RangePolicy<>(0, entries.extent_int(0)), KOKKOS_LAMBDA(int k) {
        for (int l = 0; l < functions; ++l) of_cells(k, l) = u(entries(k, l));
      });
}

void transform(const Table& T, LocalIndex cells, const Entry& entries, const Coefficients& u, const Coefficients& out) {
  Kokkos::parallel_for("thixis::method::transform", range(cells), Transform{T, entries, u, out});
}

void restrict_to_children(const Children& children, const Block2& coarse, const Block2& fine) {
  Kokkos::parallel_for("thixis::method::restrict_to_children", range(fine.extent_int(0)), RestrictToChildren{children, coarse, fine});
}

void moments_of(const Table& M, const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, LocalIndex first, const Block2& u,
                const Block2& F) {
  Kokkos::parallel_for("thixis::method::moments_of", range(F.extent_int(0)),
                       MomentsOf{M, mesh.coordinates, mesh.cell_vertices, cells, first, u, F});
}

void invert_mass(const Table& M_inverse, const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, LocalIndex count,
                 const ElementUnknowns& columns, const Entry& entries, const Values& X3, const Coefficients& lambda) {
  Kokkos::parallel_for("thixis::method::invert_mass", range(count),
                       InvertMass{M_inverse, mesh.coordinates, mesh.cell_vertices, cells, columns, entries, X3, lambda});
}

double deepest(const CellFunctions& functions, LocalIndex first, LocalIndex cells, const Table& lambda, const Block2& obstacle,
               const Entry& entries, const Coefficients& u) {
  double depth = 0;
  Kokkos::parallel_reduce("thixis::method::deepest", range(cells), Deepest{functions, first, lambda, obstacle, entries, u},
                          Kokkos::Max<double>(depth));
  return depth > 0 ? depth : 0;
}

}  // namespace thixis::method
