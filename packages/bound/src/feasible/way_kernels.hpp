#pragma once
#include "feasible/feasible_kernel.hpp"

namespace thixis::bound {

/// u_h - s_c, s_c - s_N and the gap of s_N in a cell.
struct WayOfCells {
  CellEntries of_cells, of_cells_u;
  View<const double*> theta;
  double apart[2];
  method::CellFunctions functions;
  Matrix modal;
  int count;
  View<const double*> upper, lower;  ///< s_c
  method::Coefficients u1, u2;
  CellTable averages1, averages2, closing1, closing2, gap;  ///< out, overwritten

  KOKKOS_FUNCTION void put(int K, const double* c, const CellTable& out) const {
    const int n = functions.size();
    for (int m = 0; m < n; ++m) {
      double value = 0;
      for (int l = 0; l < n; ++l) value += modal(m, l) * c[l];
      out(K, m) = value;
    }
  }
  KOKKOS_FUNCTION void operator()(int K) const {
    const int n = functions.size();
    double open[reference::max_functions], closing[2][reference::max_functions], jump[reference::max_functions];
    for (int l = 0; l < n; ++l) {
      const LocalIndex e = of_cells(K, l);
      open[l] = upper(e) - lower(e);
      const double below = open[l] < 0 ? -open[l] : 0, share = theta.extent(0) > 0 ? theta(e) : apart[0];
      closing[0][l] = -share * below;
      closing[1][l] = (1 - share) * below;
      if (below > 0) open[l] = 0;
    }
    double c[reference::max_functions];
    functions.to_bernstein(open, c);
    for (int k = 0; k < n; ++k) gap(K, k) = c[k];
    for (int alpha = 0; alpha < count; ++alpha) {
      const CellTable &of_averages = alpha == 0 ? averages1 : averages2, &of_closing = alpha == 0 ? closing1 : closing2;
      if (of_closing.extent(0) > 0) put(K, closing[alpha], of_closing);
      if (of_averages.extent(0) == 0) continue;
      for (int l = 0; l < n; ++l) jump[l] = (alpha == 0 ? u1 : u2)(of_cells_u(K, l)) - (alpha == 0 ? upper : lower)(of_cells(K, l));
      put(K, jump, of_averages);
    }
  }
};

/// |max(-g, 0) - max(-g', 0)| <= |g - g'|, and <= max(-g, 0) + max(-g', 0) <= what the coefficients say; it vanishes where both g, g' >= 0.
struct NegativePartInTime {
  FeasibleParts now, then;
  bool has_then;
  CellTable gap, gap_before;
  View<double* [2]> change_of_lift;
  View<double*> size;  ///< out, overwritten

  KOKKOS_FUNCTION double lowest(const FeasibleParts& of, int K, const double* c) const {
    double low = 0;
    for (int k = 0; k < of.functions.size(); ++k) low = c[k] < low ? c[k] : low;
    const LocalIndex place = of.deviation(K);
    return place < 0 ? -low : of.deviation.bound(place) - low;
  }
  KOKKOS_FUNCTION void operator()(int K) const {
    const int n = now.functions.size();
    size(K) = 0;
    const bool moves = now.moves(K, &gap(K, 0)), moved = has_then && then.moves(K, &gap_before(K, 0));
    if (!moves && !moved) return;
    const double area = mesh::cell_geometry(now.x, now.vertices, K).area;
    const double at_most = std::sqrt(area) * ((moves ? lowest(now, K, &gap(K, 0)) : 0) + (moved ? lowest(then, K, &gap_before(K, 0)) : 0));
    size(K) = at_most;
    if (!has_then) return;
    double square = 0;
    for (int m = 0; m < n; ++m) {
      double value = 0;
      for (int k = 0; k < n; ++k) value += now.to_modal(m, k) * (gap(K, k) - gap_before(K, k));
      square += value * value;
    }
    double change = std::sqrt(2 * area * square);
    for (int alpha = 0; change_of_lift.extent(0) > 0 && alpha < 2; ++alpha) change += change_of_lift(K, alpha);
    size(K) = change < at_most ? change : at_most;
  }
};

}  // namespace thixis::bound
