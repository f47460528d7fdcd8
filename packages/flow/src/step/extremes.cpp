#include "step/extremes.hpp"

#include <algorithm>
#include <cmath>

#include "step/vectors.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

struct Largest {
  VectorIn x;
  int unknown;
  KOKKOS_FUNCTION void operator()(LocalIndex K, double& largest) const {
    const double value = x(unknowns_per_cell * K + unknown, 0), size = value < 0 ? -value : value;
    if (largest < size) largest = size;
  }
};

/// Its left end, and the right one of its gas.
struct Ends {
  VectorIn x;
  double trace;
  fv::View<LocalIndex**> cell_vertices;
  fv::View<double* [2]> vertex;
  KOKKOS_FUNCTION void operator()(LocalIndex K, double& left, double& right) const {
    for (int i = 0; i < cell_vertices.extent_int(1); ++i) {
      const double at = vertex(cell_vertices(K, i), 0);
      if (at < left) left = at;
      if (x(unknowns_per_cell * K + gas_saturation, 0) > trace && right < at) right = at;
    }
  }
};

struct Range {
  fv::View<double* [2]> vertex;
  int axis;
  KOKKOS_FUNCTION void operator()(LocalIndex v, double& low, double& high) const {
    if (vertex(v, axis) < low) low = vertex(v, axis);
    if (high < vertex(v, axis)) high = vertex(v, axis);
  }
};

}  // namespace

double largest(const Vector& X, Unknown u) {
  double size = 0;
  Kokkos::parallel_reduce("thixis::flow::largest", Cells(0, static_cast<LocalIndex>(X.getLocalLength()) / unknowns_per_cell),
                          Largest{read(X), u}, Kokkos::Max<double>(size));
  return algebra::comm_of(*X.getMap()).max(std::max(size, 0.0));
}

double right_end_of_gas(const TwoPhaseOperator& flow, const Vector& X, double trace) {
  const fv::Grid& grid = flow.grid();
  double left = 0, right = 0;
  Kokkos::parallel_reduce("thixis::flow::ends", Cells(0, grid.owned_cells), Ends{read(X), trace, grid.cell_vertices, grid.vertex},
                          Kokkos::Min<double>(left), Kokkos::Max<double>(right));
  left = grid.comm.min(left);
  return std::max(left, grid.comm.max(right));
}

double volume(const fv::Grid& grid) {
  double sum = 0;
  const auto of_cell = grid.volume;
  Kokkos::parallel_reduce(
      "thixis::flow::volume", Cells(0, grid.owned_cells), KOKKOS_LAMBDA(LocalIndex K, double& all) { all += of_cell(K); }, sum);
  return grid.comm.sum(sum);
}

double squared_diagonal(const fv::Grid& grid) {
  double square = 0;
  for (int axis = 0; axis < 2; ++axis) {
    double low = 0, high = 0;
    Kokkos::parallel_reduce("thixis::flow::range", Cells(0, grid.vertices), Range{grid.vertex, axis}, Kokkos::Min<double>(low),
                            Kokkos::Max<double>(high));
    square += std::pow(grid.comm.max(high) - grid.comm.min(low), 2);
  }
  return square;
}

}  // namespace thixis::flow
