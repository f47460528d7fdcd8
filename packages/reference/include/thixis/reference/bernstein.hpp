#pragma once
#include <Kokkos_Core.hpp>

namespace thixis::reference {

constexpr int max_degree = 4;
constexpr int max_functions = (max_degree + 1) * (max_degree + 2) / 2;  ///< dim P_4 = 15

/// The Bernstein basis of P_p on a triangle, for kernels,
///
///     B_k(lambda) = p! / (e_0! e_1! e_2!) lambda_0^{e_0} lambda_1^{e_1} lambda_2^{e_2},   e = exponent[k],  |e| = p,
///
/// in barycentric coordinates lambda. B_k >= 0, sum_k B_k = 1: a polynomial lies between its smallest and its largest coefficient.
struct Bernstein {
  int degree = 0, size = 0;
  int exponent[max_functions][3] = {};
  double factor[max_functions] = {};

  /// B[k] = B_k(lambda).
  KOKKOS_INLINE_FUNCTION void values(const double (&lambda)[3], double* B) const {
    double power[3][max_degree + 1];
    powers(lambda, power);
    for (int k = 0; k < size; ++k) B[k] = factor[k] * power[0][exponent[k][0]] * power[1][exponent[k][1]] * power[2][exponent[k][2]];
  }

  /// The polynomial sum_k c_k B_k at lambda.
  KOKKOS_INLINE_FUNCTION double value(const double* c, const double (&lambda)[3]) const {
    double power[3][max_degree + 1], sum = 0;
    powers(lambda, power);
    for (int k = 0; k < size; ++k) sum += c[k] * factor[k] * power[0][exponent[k][0]] * power[1][exponent[k][1]] * power[2][exponent[k][2]];
    return sum;
  }

  /// dB[k][a] = ∂B_k/∂lambda_a, the three coordinates taken as independent.
  KOKKOS_INLINE_FUNCTION void derivatives(const double (&lambda)[3], double (*dB)[3]) const {
    double power[3][max_degree + 1];
    powers(lambda, power);
    for (int k = 0; k < size; ++k)
      for (int a = 0; a < 3; ++a) dB[k][a] = derivative(k, a, power);
  }

  /// sum[a] = ∂/∂lambda_a sum_k c_k B_k.
  KOKKOS_INLINE_FUNCTION void gradient(const double* c, const double (&lambda)[3], double (&sum)[3]) const {
    double power[3][max_degree + 1];
    powers(lambda, power);
    for (int a = 0; a < 3; ++a) {
      sum[a] = 0;
      for (int k = 0; k < size; ++k) sum[a] += c[k] * derivative(k, a, power);
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION void powers(const double (&lambda)[3], double (&power)[3][max_degree + 1]) const {
    for (int a = 0; a < 3; ++a) {
      power[a][0] = 1;
      for (int e = 1; e <= degree; ++e) power[a][e] = power[a][e - 1] * lambda[a];
    }
  }
  KOKKOS_INLINE_FUNCTION double derivative(int k, int a, const double (&power)[3][max_degree + 1]) const {
    const int e = exponent[k][a], b = (a + 1) % 3, c = (a + 2) % 3;
    return e == 0 ? 0 : factor[k] * e * power[a][e - 1] * power[b][exponent[k][b]] * power[c][exponent[k][c]];
  }
};

}  // namespace thixis::reference
