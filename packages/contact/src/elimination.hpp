#pragma once
#include <cmath>
#include <limits>

#include "local_factors.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/method/graph.hpp"

/// Kernels of static condensation (thixis/contact/condensation.hpp).
namespace thixis::contact {

using method::ElementUnknowns;
using Block2 = Kokkos::View<double**, Kokkos::LayoutRight>;
using Block3 = Kokkos::View<double***, Kokkos::LayoutRight>;
using Input = decltype(std::declval<const algebra::Vector&>().getLocalViewDevice(Tpetra::Access::ReadOnly));
using Output = decltype(std::declval<algebra::Vector&>().getLocalViewDevice(Tpetra::Access::ReadWrite));

/// Partial LU factorization of the local matrices, in place: S replaces A_BB. Finds the first element that has none.
struct Eliminate {
  ElementUnknowns elements;
  LocalIndex first;
  LocalIndex kept;  ///< factors are kept of the elements before this one
  Block3 A;
  LocalFactors factors;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e, LocalIndex& singular) const {
    double* a = &A(e, 0, 0);
    detach_fixed(e, a);
    const bool regular = factors.symmetric ? factor_symmetric(a) : factor_general(e, a);
    if (!regular && first + e < singular) singular = first + e;
    if (first + e < kept) keep(e, a);
  }

  /// Interior unknowns -1 become identity rows and columns.
  KOKKOS_FUNCTION void detach_fixed(int e, double* a) const {
    const int n = factors.n;
    for (int k = 0; k < factors.m; ++k) {
      if (elements(first + e, k) >= 0) continue;
      for (int j = 0; j < n; ++j) a[k * n + j] = a[j * n + k] = 0;
      a[k * n + k] = 1;
    }
  }

  // A pivot is zero if it is nothing but rounding in a_kk = U_kk + sum over i < k of L_ki U_ik: a test without units. Pivots are inverted
  // in place.

  /// U_i = A_i - sum over k < i of L_ik U_k, row by row on and above the diagonal, where L_ik = U_ki / U_kk; two k at a time take half the
  /// loads and stores. S is mirrored to below the diagonal.
  KOKKOS_FUNCTION bool factor_symmetric(double* a) const {
    const int n = factors.n, m = factors.m;
    for (int i = 0; i < n; ++i) {
      double* __restrict__ row = a + i * n;
      const double diagonal = row[i];
      const int last = i < m ? i : m;
      int k = 0;
      for (; k + 1 < last; k += 2) {
        const double *u = a + k * n, *v = u + n;
        const double L_iu = u[i] * u[k], L_iv = v[i] * v[k + 1];
        for (int j = i; j < n; ++j) row[j] -= L_iu * u[j] + L_iv * v[j];
      }
      if (k < last) {
        const double* u = a + k * n;
        const double L_iu = u[i] * u[k];
        for (int j = i; j < n; ++j) row[j] -= L_iu * u[j];
      }
      if (i >= m) continue;
      if (!(row[i] > rounding() * diagonal)) return false;
      row[i] = 1 / row[i];
    }
    for (int i = m; i < n; ++i)
      for (int j = m; j < i; ++j) a[i * n + j] = a[j * n + i];
    return true;
  }

  KOKKOS_FUNCTION bool factor_general(int e, double* a) const {
    const int n = factors.n, m = factors.m;
    for (int k = 0; k < m; ++k) {
      int pivot = k;
      for (int i = k + 1; i < m; ++i)
        if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
      if (first + e < kept) factors.pivot(first + e, k) = pivot;
      double* u = a + k * n;
      for (int j = 0; j < n && pivot != k; ++j) {
        const double exchanged = u[j];
        u[j] = a[pivot * n + j];
        a[pivot * n + j] = exchanged;
      }
      double terms = std::abs(u[k]);
      for (int i = 0; i < k; ++i) terms += std::abs(u[i] * a[i * n + k]);
      if (!(std::abs(u[k]) > rounding() * terms)) return false;
      u[k] = 1 / u[k];
      for (int i = k + 1; i < n; ++i) {
        double* __restrict__ row = a + i * n;
        const double L_ik = row[k] *= u[k];
        for (int j = k + 1; j < n; ++j) row[j] -= L_ik * u[j];
      }
    }
    return true;
  }

  KOKKOS_FUNCTION double rounding() const { return factors.m * std::numeric_limits<double>::epsilon(); }

  KOKKOS_FUNCTION void keep(int e, const double* a) const {
    const int n = factors.n, m = factors.m;
    double* U = &factors.U(first + e, 0);
    for (int k = 0; k < m; ++k)
      for (int j = k; j < n; ++j) *U++ = a[k * n + j];
    if (factors.symmetric) return;
    double* L = &factors.L(first + e, 0);
    for (int i = 1; i < n; ++i)
      for (int k = 0; k < (i < m ? i : m); ++k) *L++ = a[i * n + k];
  }
};

/// y_B = -A_BI A_II^{-1} b_I; unknowns of other ranks count as 0 in b_I.
struct Reduce {
  ElementUnknowns elements;
  LocalIndex first;
  LocalFactors factors;
  Input b;
  Block2 y;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    for (int i = 0; i < factors.n; ++i) {
      const LocalIndex row = i < factors.m ? elements(first + e, i) : -1;
      y(e, i) = row >= 0 && row < b.extent_int(0) ? b(row, 0) : 0;
    }
    factors.forward(first + e, &y(e, 0), factors.n);
  }
};

/// x_I = A_II^{-1} (b_I - A_IB x_B).
struct Recover {
  ElementUnknowns elements, remaining;
  LocalIndex first;
  LocalFactors factors;
  Input b, x_remaining;
  Block2 y;
  Output x;  ///< out, rows of I overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const int n = factors.n, m = factors.m;
    for (int i = 0; i < m; ++i) {
      const LocalIndex row = elements(first + e, i);
      y(e, i) = row >= 0 && row < b.extent_int(0) ? b(row, 0) : 0;
    }
    for (int i = m; i < n; ++i) {
      const LocalIndex column = remaining(first + e, i);
      y(e, i) = column >= 0 ? x_remaining(column, 0) : 0;
    }
    factors.forward(first + e, &y(e, 0), m);
    factors.backward(first + e, &y(e, 0));
    for (int i = 0; i < m; ++i)
      if (const LocalIndex row = elements(first + e, i); row >= 0 && row < x.extent_int(0)) x(row, 0) = y(e, i);
  }
};

}  // namespace thixis::contact
