#pragma once
#include "kernels/polynomial_kernels.hpp"
#include "transfer/terms.hpp"

namespace thixis::method {

/// How the unknowns of a space come from polynomials in the parents of its patch cells.
struct Restriction {
  int components = 1;
  FunctionalsOfChildren W;
  View<LocalIndex*> shape, parent;  ///< of each patch cell; parents by row of `source`
  View<LocalIndex*> begin, cell;    ///< Terms
  View<int*> place;

  /// The value in a cell of what stands at place i there, from `source`: (parent, j) -> position in x, -1 for 0.
  template <class X>
  KOKKOS_INLINE_FUNCTION double value(LocalIndex k, int i, const ElementEntries& source, const X& x) const {
    const int q = i / components, m = i % components;
    double sum = 0;
    for (int j = 0; j < W.extent_int(2); ++j) {
      const LocalIndex at = source(parent(k), components * j + m);
      if (at >= 0) sum += W(shape(k), q, j) * x(at);
    }
    return sum;
  }
};

/// out(r) = the mean of the terms of r.
template <class X, class Out>
struct Prolongate {
  Restriction by;
  ElementEntries source;
  X x;
  Out out;  ///< overwritten

  KOKKOS_FUNCTION void operator()(int r) const {
    const LocalIndex first = by.begin(r), last = by.begin(r + 1);
    double sum = 0;
    for (LocalIndex t = first; t < last; ++t) {
      const int i = by.place(t);
      sum += i < 0 ? -by.value(by.cell(t), -1 - i, source, x) : by.value(by.cell(t), i, source, x);
    }
    out(r, 0) = sum / (last - first);
  }
};

/// x += the transpose of that.
template <class R, class X>
struct Collect {
  Restriction by;
  ElementEntries source;
  R r;
  X x;

  KOKKOS_FUNCTION void operator()(int row) const {
    const LocalIndex first = by.begin(row), last = by.begin(row + 1);
    const double part = r(row, 0) / (last - first);
    for (LocalIndex t = first; t < last; ++t) {
      const int i = by.place(t), place = i < 0 ? -1 - i : i, q = place / by.components, m = place % by.components;
      const LocalIndex k = by.cell(t);
      for (int j = 0; j < by.W.extent_int(2); ++j) {
        const LocalIndex at = source(by.parent(k), by.components * j + m);
        if (at >= 0) Kokkos::atomic_add(&x(at), (i < 0 ? -part : part) * by.W(by.shape(k), q, j));
      }
    }
  }
};

/// F(e, l) = (u, psi_l)_K for the polynomial u of the parent, in the patch cells first + e.
struct MomentsOfParents {
  Restriction by;
  ElementEntries source;
  Coefficients x;
  Table M;
  View<double* [2]> coordinates;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  LocalIndex first;
  Block2 F;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const int n = M.extent_int(0);
    const double scale = 2 * mesh::cell_area(coordinates, vertices, cells(first + e));
    double u[reference::max_functions];
    for (int l = 0; l < n; ++l) u[l] = by.value(first + e, l, source, x);
    for (int l = 0; l < n; ++l) {
      double sum = 0;
      for (int m = 0; m < n; ++m) sum += M(l, m) * u[m];
      F(e, l) = scale * sum;
    }
  }
};

}  // namespace thixis::method
