#pragma once
#include "thixis/reference/bernstein.hpp"

namespace thixis::reference {

/// The gradient of a polynomial of degree p as polynomials of degree p - 1, for kernels: with e(k) the exponents of degree p - 1,
///
///     ∂/∂lambda_a sum_m c_m B_m = p sum_k c_{e(k) + 1_a} B_k.
struct BernsteinGradient {
  static constexpr int most = max_degree * (max_degree + 1) / 2;  ///< dim P_3 = 10
  int degree = 0;                                                 ///< p
  Bernstein lower;                                                ///< of degree p - 1
  int raised[most][3] = {};                                       ///< the index of e(k) + 1_a

  /// Coefficients of the derivatives along x and y from those of the polynomial; gradient[a][d] = ∂lambda_a/∂x_d.
  KOKKOS_INLINE_FUNCTION void coefficients(const double* c, const double (&gradient)[3][2], double (&along)[2][most]) const {
    for (int k = 0; k < lower.size; ++k)
      for (int d = 0; d < 2; ++d) {
        double sum = 0;
        for (int a = 0; a < 3; ++a) sum += gradient[a][d] * c[raised[k][a]];
        along[d][k] = degree * sum;
      }
  }
};

/// Of polynomials in this basis, of degree 1 … 4.
BernsteinGradient bernstein_gradient(const Bernstein& basis);

}  // namespace thixis::reference
