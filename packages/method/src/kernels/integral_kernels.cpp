#include "kernels/polynomial_kernels.hpp"
#include "thixis/reference/bernstein_gradient.hpp"

namespace thixis::method {
namespace {

constexpr int most = reference::max_functions;

struct Moments {
  CellFunctions functions;
  Table at_rule;
  QuadratureBlock block;
  Values f;
  Component component;
  Block2 F;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    if (block.own_rule(e) < 0) by_table(e);
    else by_points(e);
  }
  KOKKOS_FUNCTION void by_table(int e) const {
    const int n = functions.size(), begin = block.offset(e), points = block.offset(e + 1) - begin;
    double sum[most] = {};
    for (int q = 0; q < points; ++q) {
      const double wf = block.weight(begin + q) * f(begin + q);
      for (int l = 0; l < n; ++l) sum[l] += wf * at_rule(q, l);
    }
    for (int l = 0; l < n; ++l) F(e, component(l)) = sum[l];
  }
  KOKKOS_FUNCTION void by_points(int e) const {
    const int n = functions.size();
    double B[most], sum[most] = {};
    for (int q = block.offset(e); q < block.offset(e + 1); ++q) {
      const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
      functions.B.values(lambda, B);
      const double wf = block.weight(q) * f(q);
      for (int k = 0; k < n; ++k) sum[k] += wf * B[k];
    }
    for (int l = 0; l < n; ++l) F(e, component(l)) = functions.moment(sum, l);
  }
};

struct GradientError {
  CellFunctions functions;
  reference::BernsteinGradient derivative;
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
    double gradient[2][reference::BernsteinGradient::most], B[reference::BernsteinGradient::most];
    derivative.coefficients(c, K.gradient, gradient);
    const bool compared = known.x.extent(0) > 0;
    for (int q = block.offset(e); q < block.offset(e + 1); ++q) {
      const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
      derivative.lower.values(lambda, B);
      double dx = compared ? -known.x(q) : 0, dy = compared ? -known.y(q) : 0;
      for (int k = 0; k < derivative.lower.size; ++k) {
        dx += gradient[0][k] * B[k];
        dy += gradient[1][k] * B[k];
      }
      sum += block.weight(q) * known.mu(q) * (dx * dx + dy * dy);
    }
  }
};

struct ValueError {
  CellFunctions functions;
  QuadratureBlock block;
  Values known;
  Entry entries;
  Component component;
  Coefficients u;

  KOKKOS_FUNCTION void operator()(int e, double& sum) const {
    const int n = functions.size();
    double local[most], c[most], B[most];
    for (int l = 0; l < n; ++l) local[l] = u(entries(block.first + e, component(l)));
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

void moments(const CellFunctions& functions, const Table& at_rule, const QuadratureBlock& block, const Values& f,
             const Component& component, const Block2& F) {
  Kokkos::parallel_for("thixis::method::moments", range(block.cells), Moments{functions, at_rule, block, f, component, F});
}

double value_error(const CellFunctions& functions, const QuadratureBlock& block, LocalIndex cells, const Values& known,
                   const Entry& entries, const Component& component, const Coefficients& u) {
  double sum = 0;
  Kokkos::parallel_reduce("thixis::method::value_error", range(cells), ValueError{functions, block, known, entries, component, u}, sum);
  return sum;
}

double gradient_error(const CellFunctions& functions, const mesh::Mesh& mesh, const QuadratureBlock& block, LocalIndex cells,
                      const AtPoints& known, const Entry& entries, const Coefficients& u) {
  GradientError kernel;
  kernel.functions = functions;
  kernel.derivative = reference::bernstein_gradient(functions.B);
  kernel.x = mesh.coordinates;
  kernel.vertices = mesh.cell_vertices;
  kernel.block = block;
  kernel.known = known;
  kernel.entries = entries;
  kernel.u = u;
  double sum = 0;
  Kokkos::parallel_reduce("thixis::method::gradient_error", range(cells), kernel, sum);
  return sum;
}

double deepest(const CellFunctions& functions, LocalIndex first, LocalIndex cells, const Table& lambda, const Block2& obstacle,
               const Entry& entries, const Coefficients& u) {
  double depth = 0;
  Kokkos::parallel_reduce("thixis::method::deepest", range(cells), Deepest{functions, first, lambda, obstacle, entries, u},
                          Kokkos::Max<double>(depth));
  return depth > 0 ? depth : 0;
}

}  // namespace thixis::method
