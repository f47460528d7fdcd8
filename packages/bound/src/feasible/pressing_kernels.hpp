#pragma once
#include <type_traits>

#include "feasible/feasible_kernel.hpp"

/// Kernels of Pressing: what cells add to sums at their vertices, (vertex, column).
namespace thixis::bound {

/// Cells share vertices: threads add up in any order.
template <class Sums>
KOKKOS_INLINE_FUNCTION void add_at(const Sums& sums, LocalIndex vertex, int column, double value) {
  if constexpr (std::is_same_v<typename Sums::execution_space, Kokkos::Serial>) sums(vertex, column) += value;
  else Kokkos::atomic_add(&sums(vertex, column), value);
}

/// Column 0: |||psi_a|||².
template <class Sums>
struct SumStiffness {
  FeasibleParts parts;
  double hat[3][reference::max_functions];  ///< Bernstein coefficients of psi_a
  Sums sums;

  KOKKOS_FUNCTION void operator()(int K) const {
    const mesh::CellGeometry geometry = mesh::cell_geometry(parts.x, parts.vertices, K);
    for (int i = 0; i < 3; ++i)
      add_at(sums, parts.vertices(K, i), 0,
             parts.stiffness(K) * gradient_square(parts.energy.products, geometry, parts.functions.size(), hat[i]));
  }
};

/// Column 0: |||D|||²; column 1: how many cells have D on a held face of the vertex.
template <class Sums>
struct SumDeviation {
  FeasibleParts parts;
  View<double*> mean_of_positive;  ///< out, overwritten: by place, of max(D, 0)
  Sums sums;

  KOKKOS_FUNCTION void operator()(int K) const {
    const Deviation& D = parts.deviation;
    const LocalIndex place = D(K);
    if (place < 0) return;
    const double area = mesh::cell_area(parts.x, parts.vertices, K);
    double square = 0, mean = 0;
    const PointsOf points(D.quadrature, place);
    for (int q = 0; q < points.count; ++q) {
      const GlobalIndex at = points.first + q;
      const double value = D.at_points(at, 0), dx = D.at_points(at, 1), dy = D.at_points(at, 2);
      mean += 2 * points.weight(q) * (value < 0 ? 0 : value);
      square += 2 * area * points.weight(q) * (dx * dx + dy * dy);
    }
    mean_of_positive(place) = mean;
    for (int i = 0; i < 3; ++i) {
      add_at(sums, parts.vertices(K, i), 0, parts.stiffness(K) * square);
      if (!D.on_held(place, i)) continue;
      for (int end = 1; end < 3; ++end) add_at(sums, parts.vertices(K, (i + end) % 3), 1, 1);
    }
  }
};

/// Columns 0, 1: (lambda^, max(psi_a, 0)) and (lambda^, max(D, 0)); 2: how many cells have a gap at functions with a mean; 3: how many have
/// a gap that is nowhere below |D|.
template <class Sums>
struct SumForces {
  FeasibleParts parts;
  double positive[3];                    ///< ∫ max(psi_a, 0) over the reference triangle, times 2
  View<const LocalIndex*> place;         ///< of D; of length 0: there is none
  View<const double*> mean_of_positive;  ///< by place, of max(D, 0)
  bool closes;
  Sums sums;

  KOKKOS_FUNCTION void operator()(int K) const {
    const double force = parts.lambda(K, 0) * Kokkos::Experimental::sqrt(0.5);
    const LocalIndex at = place.extent(0) > 0 ? place(K) : -1;
    const bool apart = closes && comes_apart(K), open = at >= 0 && is_open(K, at);
    for (int i = 0; i < 3; ++i) {
      const LocalIndex v = parts.vertices(K, i);
      add_at(sums, v, 0, positive[i] * force);
      if (at >= 0) add_at(sums, v, 1, mean_of_positive(at) * force);
      if (apart) add_at(sums, v, 2, 1);
      if (open) add_at(sums, v, 3, 1);
    }
  }

  /// Whether functions with a mean leave a gap that can be compared with those at vertices: where membranes come apart, quadratically, it
  /// is a quarter half the way to a vertex.
  KOKKOS_FUNCTION bool comes_apart(int K) const {
    double at_vertices = 0, at_others = 0;
    for (int l = 0; l < parts.functions.size(); ++l) {
      const bool vertex = l >= parts.first_vertex && l < parts.first_vertex + 3;
      const double open = gap(K, l);
      if (vertex && open > at_vertices) at_vertices = open;
      if (!vertex && open > at_others) at_others = open;
    }
    return at_others > at_vertices / 16;
  }

  /// Whether the gap of s_N is nowhere below |D|, by its Bernstein coefficients.
  KOKKOS_FUNCTION bool is_open(int K, LocalIndex at) const {
    double open[reference::max_functions] = {}, c[reference::max_functions] = {};
    const int n = parts.functions.size();
    for (int l = 0; l < n; ++l) open[l] = gap(K, l) < 0 ? 0 : gap(K, l);
    parts.functions.to_bernstein(open, c);
    for (int k = 0; k < n; ++k)
      if (!(c[k] >= parts.deviation.bound(at))) return false;
    return true;
  }

  KOKKOS_FUNCTION double gap(int K, int l) const {
    const LocalIndex e = parts.of_cells(K, l);
    return parts.s_c[0](e) - parts.s_c[1](e);
  }
};

}  // namespace thixis::bound
