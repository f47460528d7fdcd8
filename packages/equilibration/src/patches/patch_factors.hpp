#pragma once
#include "patches/packed_cholesky.hpp"
#include "patches/patch_tables.hpp"
#include "patches/patches.hpp"

/// What PatchFlux makes once per mesh, and the form of a cell that all its kernels ask.
namespace thixis::equilibration {

using Bubbles = Kokkos::View<double**, Kokkos::LayoutRight>;

/// What a cell does with short fields: scalar products in its metric, and the bubbles that a field of least norm has.
template <int Q>
struct CellForm {
  using T = PatchTables<Q>;
  T tables;
  Metrics metric;
  Bubbles inverse;  ///< of (bubble, bubble)_K: (cell, m n + l)

  /// z = G v.
  KOKKOS_INLINE_FUNCTION void weigh(int k, const double* v, double* z) const {
    const Metric g = metric(k);
    for (int l = 0; l < T::density; ++l) {
      z[l] = g.G00 * v[l] + g.G01 * v[T::density + l];
      z[T::density + l] = g.G01 * v[l] + g.G11 * v[T::density + l];
    }
  }
  /// The bubbles sum_m y_m bubble(m) nearest to v.
  KOKKOS_INLINE_FUNCTION void nearest(int k, const double* v, double* y) const {
    double z[T::length], product[T::stored_bubbles] = {};
    weigh(k, v, z);
    for (int l = 0; l < T::length; ++l)
      for (int m = 0; m < T::bubbles; ++m) product[m] += tables.bubble_transposed(l, m) * z[l];
    for (int m = 0; m < T::bubbles; ++m) {
      y[m] = 0;
      for (int n = 0; n < T::bubbles; ++n) y[m] += inverse(k, m * T::bubbles + n) * product[n];
    }
  }
  /// r_t = (v, test_t)_K at corner i after the nearest bubbles have been taken from v.
  KOKKOS_INLINE_FUNCTION void test(int k, int i, double* v, double* r) const {
    if constexpr (T::bubbles > 0) {
      double y[T::stored_bubbles];
      nearest(k, v, y);
      for (int m = 0; m < T::bubbles; ++m)
        for (int l = 0; l < T::length; ++l) v[l] -= y[m] * tables.bubble(m, l);
    }
    double z[T::length], sum[T::tests] = {};
    weigh(k, v, z);
    for (int l = 0; l < T::length; ++l)
      for (int t = 0; t < T::tests; ++t) sum[t] += tables.test(i, l, t) * z[l];
    for (int t = 0; t < T::tests; ++t) r[t] = sum[t];
  }
};

/// Inverse matrices of the bubbles of each cell.
template <int Q>
struct InvertBubbles {
  using T = PatchTables<Q>;
  CellForm<Q> form;  ///< its inverse is overwritten

  KOKKOS_FUNCTION void operator()(int k) const {
    constexpr int n = T::bubbles;
    double A[T::stored_bubbles * (T::stored_bubbles + 1) / 2];
    for (int m = 0; m < n; ++m) {
      double z[T::length];
      form.weigh(k, &form.tables.bubble(m, 0), z);
      for (int j = 0; j <= m; ++j) {
        double product = 0;
        for (int l = 0; l < T::length; ++l) product += z[l] * form.tables.bubble(j, l);
        A[row_of(m) + j] = product;
      }
    }
    factor_packed(n, A);
    for (int m = 0; m < n; ++m) {
      double x[T::stored_bubbles] = {};
      x[m] = 1;
      solve_packed(n, A, x);
      for (int j = 0; j < n; ++j) form.inverse(k, j * n + m) = x[j];
    }
  }
};

/// Number of the unknown of patch P that belongs to test field t of its cell m, -1 if its flux is given.
template <int Q>
KOKKOS_INLINE_FUNCTION int unknown(const Patch& P, int m, int t) {
  if (t == 2 * Q) return P.free == P.spokes ? Q * P.free : -1;
  const int spoke = t < Q ? m : (m + 1) % P.spokes, place = spoke - P.first_free;
  return place < 0 || place >= P.free ? -1 : place * Q + (t < Q ? t : t - Q);
}

/// The matrix of a patch, bubbles eliminated, factored.
template <int Q>
struct FactorPatch {
  using T = PatchTables<Q>;
  Patches patches;
  CellForm<Q> form;
  View<double*> factor;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int p) const {
    const Patch P = patches.patch(p);
    const int n = P.size(Q);
    double* const A = factor.data() + P.factor;
    for (int e = 0; e < row_of(n); ++e) A[e] = 0;
    for (int m = 0; m < P.cells; ++m) {
      const int corner = patches.corner(P.corner + m), k = corner / 3, i = corner % 3;
      for (int t = 0; t < T::tests; ++t) {
        const int column = unknown<Q>(P, m, t);
        if (column < 0) continue;
        double v[T::length], r[T::tests];
        for (int l = 0; l < T::length; ++l) v[l] = form.tables.test(i, l, t);
        form.test(k, i, v, r);
        for (int s = 0; s < T::tests; ++s) {
          const int row = unknown<Q>(P, m, s);
          if (row >= column) A[row_of(row) + column] += r[s];
        }
      }
    }
    factor_packed(n, A);
  }
};

}  // namespace thixis::equilibration
