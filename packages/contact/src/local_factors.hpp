#pragma once
#include <Kokkos_Core.hpp>

#include "thixis/core/types.hpp"

namespace thixis::contact {

/// Partial factors of the local matrices of elements: n unknowns each, the first m eliminated. With row exchanges among the first m,
///
///     A = [ L_II 0; L_BI 1 ] [ U_II U_IB; 0 S ],      L_II with unit diagonal.
///
/// For symmetric matrices L(i, k) = U(k, i) / U(k, k) is not kept, and rows are not exchanged.
struct LocalFactors {
  template <class T>
  using PerElement = Kokkos::View<T**, Kokkos::LayoutRight>;

  int n = 0, m = 0;
  bool symmetric = false;
  PerElement<double> U;   ///< (element, row by row: 1 / U(k, k) and U(k, j), k < j < n)
  PerElement<double> L;   ///< (element, row by row: L(i, k), k < i and k < m); empty if symmetric
  PerElement<int> pivot;  ///< (element, k): the row that was exchanged with row k in step k; empty if symmetric

  LocalFactors() = default;
  LocalFactors(LocalIndex elements, int unknowns, int eliminated, bool symmetric_matrices)
      : n(unknowns),
        m(eliminated),
        symmetric(symmetric_matrices),
        U("thixis::contact::upper_factors", elements, upper_begin(m)),
        L("thixis::contact::lower_factors", symmetric ? 0 : elements, lower_begin(n)),
        pivot("thixis::contact::pivots", symmetric ? 0 : elements, m) {}

  KOKKOS_FUNCTION int upper_begin(int k) const { return k * n - k * (k - 1) / 2; }
  KOKKOS_FUNCTION int lower_begin(int i) const { return i <= m ? i * (i - 1) / 2 : m * (m - 1) / 2 + (i - m) * m; }

  /// y <- L^{-1} y for the first `last` entries: y_B becomes y_B - A_BI A_II^{-1} y_I.
  KOKKOS_FUNCTION void forward(LocalIndex e, double* y, int last) const {
    if (symmetric) {
      for (int k = 0; k < m; ++k) {
        const double* row = &U(e, upper_begin(k)) - k;
        const double factor = y[k] * row[k];
        for (int j = k + 1; j < last; ++j) y[j] -= factor * row[j];
      }
      return;
    }
    for (int k = 0; k < m; ++k) {
      const double exchanged = y[k];
      y[k] = y[pivot(e, k)];
      y[pivot(e, k)] = exchanged;
    }
    for (int i = 1; i < last; ++i) {
      const double* row = &L(e, lower_begin(i));
      double sum = y[i];
      for (int k = 0; k < (i < m ? i : m); ++k) sum -= row[k] * y[k];
      y[i] = sum;
    }
  }

  /// y_I <- U_II^{-1} (y_I - U_IB y_B).
  KOKKOS_FUNCTION void backward(LocalIndex e, double* y) const {
    for (int k = m - 1; k >= 0; --k) {
      const double* row = &U(e, upper_begin(k)) - k;
      double sum = y[k];
      for (int j = k + 1; j < n; ++j) sum -= row[j] * y[j];
      y[k] = sum * row[k];
    }
  }
};

}  // namespace thixis::contact
