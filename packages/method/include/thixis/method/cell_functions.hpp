#pragma once
#include <Kokkos_Core.hpp>

#include "thixis/mesh/geometry.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

/// A basis of P_p for kernels: psi_l = sum_k C(k, l) B_k with the Bernstein polynomials B_k.
struct CellFunctions {
  reference::Bernstein B;
  Kokkos::View<const double**, Kokkos::LayoutRight> C;

  KOKKOS_INLINE_FUNCTION int size() const { return B.size; }

  /// Bernstein coefficients of sum_l u[l] psi_l.
  KOKKOS_INLINE_FUNCTION void to_bernstein(const double* u, double* c) const {
    for (int k = 0; k < B.size; ++k) {
      c[k] = 0;
      for (int l = 0; l < B.size; ++l) c[k] += C(k, l) * u[l];
    }
  }
  /// Moments against psi_l from those against B_k.
  KOKKOS_INLINE_FUNCTION double moment(const double* of_B, int l) const {
    double sum = 0;
    for (int k = 0; k < B.size; ++k) sum += C(k, l) * of_B[k];
    return sum;
  }
  /// g[l][d] = ∂psi_l/∂x_d at lambda.
  KOKKOS_INLINE_FUNCTION void gradients(const mesh::CellGeometry& K, const double (&lambda)[3], double (*g)[2]) const {
    double dB[reference::max_functions][3];
    B.derivatives(lambda, dB);
    for (int l = 0; l < B.size; ++l) g[l][0] = g[l][1] = 0;
    for (int k = 0; k < B.size; ++k) {
      double dx[2] = {0, 0};
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) dx[d] += dB[k][a] * K.gradient[a][d];
      for (int l = 0; l < B.size; ++l)
        for (int d = 0; d < 2; ++d) g[l][d] += C(k, l) * dx[d];
    }
  }
};

CellFunctions cell_functions(const reference::CellBasis& basis);

/// A flat matrix of the host as a View.
Kokkos::View<double**, Kokkos::LayoutRight> matrix_view(const char* label, int rows, int columns, const std::vector<double>& values);

}  // namespace thixis::method
