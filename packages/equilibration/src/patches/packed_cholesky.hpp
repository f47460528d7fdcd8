#pragma once
#include <Kokkos_Core.hpp>
#include <cmath>

/// A = L L^T for symmetric positive definite matrices of any size n, lower triangles packed row by row: A_ij at i (i+1)/2 + j, j <= i. The
/// diagonal of L is kept inverted.
namespace thixis::equilibration {

KOKKOS_INLINE_FUNCTION constexpr int row_of(int i) { return i * (i + 1) / 2; }

KOKKOS_INLINE_FUNCTION void factor_packed(int n, double* A) {
  for (int i = 0; i < n; ++i) {
    double* row = A + row_of(i);
    for (int j = 0; j <= i; ++j) {
      const double* other = A + row_of(j);
      double sum = row[j];
      for (int k = 0; k < j; ++k) sum -= row[k] * other[k];
      row[j] = j < i ? sum * other[j] : 1 / std::sqrt(sum);
    }
  }
}

/// x <- A^{-1} x.
KOKKOS_INLINE_FUNCTION void solve_packed(int n, const double* L, double* x) {
  for (int i = 0; i < n; ++i) {
    const double* row = L + row_of(i);
    double sum = x[i];
    for (int k = 0; k < i; ++k) sum -= row[k] * x[k];
    x[i] = sum * row[i];
  }
  for (int i = n - 1; i >= 0; --i) {
    const double* row = L + row_of(i);
    const double value = x[i] * row[i];
    for (int k = 0; k < i; ++k) x[k] -= row[k] * value;
    x[i] = value;
  }
}

}  // namespace thixis::equilibration
