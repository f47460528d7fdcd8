#pragma once
#include "thixis/equilibration/cell_fields.hpp"

/// Kernels of RootFlux.
namespace thixis::equilibration {

/// moments(k, i) = ∫_K r lambda_i from modal coefficients of r.
struct HatMoments {
  ConstCellTable r;
  Matrix first_row;   ///< (a, k): coefficient 0 of lambda_a phi_k
  CellTable moments;  ///< out
  KOKKOS_FUNCTION void operator()(int K) const {
    for (int a = 0; a < 3; ++a) {
      double sum = 0;
      for (int k = 0; k < first_row.extent_int(1); ++k) sum += first_row(a, k) * r(K, k);
      moments(K, a) = sum;
    }
  }
};

/// g(K, a, ·) = Pi_q(psi_a r) - grad rho·grad psi_a, w = -grad rho.
struct RootSources {
  ConstCellTable r;
  Metrics metric;
  Kokkos::View<const double***, Kokkos::LayoutRight> times;  ///< (a, l, k): lambda_a phi_k -> phi_l
  Kokkos::View<const double* [3], Kokkos::LayoutRight> rho;  ///< of the cell's vertices
  CellTable density, target;                                 ///< out

  KOKKOS_FUNCTION void operator()(int K) const {
    const int n = times.extent_int(1);
    const double d0 = rho(K, 1) - rho(K, 0), d1 = rho(K, 2) - rho(K, 0), root = Kokkos::Experimental::sqrt(0.5);
    const Metric& M = metric(K);
    const double w0 = -(M.G11 * d0 - M.G01 * d1), w1 = -(M.G00 * d1 - M.G01 * d0);  // G^{-1} grad rho, det G = 1
    for (int k = 0; k < target.extent_int(1); ++k) target(K, k) = 0;
    target(K, 0) = root * w0;
    target(K, n) = root * w1;
    const double of_vertex[3] = {-w0 - w1, w0, w1};  // density of -grad rho·grad lambda_a = ŵ·grad^ lambda_a
    for (int a = 0; a < 3; ++a)
      for (int l = 0; l < n; ++l) {
        double sum = l == 0 ? root * of_vertex[a] : 0;
        for (int k = 0; k < n; ++k) sum += times(a, l, k) * r(K, k);
        density(K, a * n + l) = sum;
      }
  }
};

}  // namespace thixis::equilibration
