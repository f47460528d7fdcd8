#pragma once
#include "thixis/bound/cell_fields.hpp"

/// Kernels that turn residuals and data into what fluxes are made from.
namespace thixis::bound {

/// Modal coefficients of the representative r of a residual, (r, psi_l)_K = moments(k, l), projected on P_q.
struct Represent {
  ConstCellTable moments;
  Matrix from_moments;  ///< (mode, l)
  CellTable r;          ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int k) const {
    for (int m = 0; m < r.extent_int(1); ++m) {
      double sum = 0;
      for (int l = 0; l < from_moments.extent_int(1); ++l) sum += from_moments(m, l) * moments(k, l);
      r(k, m) = sum;
    }
  }
};

/// g_a = psi_a (f - rate - r) - (-1)^alpha (lambda^ of a) - w·grad psi_a, for the three vertices of a cell; the target is -w.
struct PatchSources {
  ConstCellTable f;
  ConstCellTable rate;  ///< of length 0: none
  ConstCellTable r_alg, r_lin, lambda, w;
  double sign;                                               ///< -(-1)^alpha
  Kokkos::View<const double***, Kokkos::LayoutRight> times;  ///< (i, m, k): lambda_i phi_k -> phi_m
  CellTable density, target;                                 ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int k) const {
    const int n = times.extent_int(1), wide = times.extent_int(2);
    double source[reference::dimension(5)];
    for (int m = 0; m < wide; ++m) source[m] = f(k, m) - (m < n ? r_alg(k, m) + r_lin(k, m) : 0);
    for (int m = 0; m < rate.extent_int(1); ++m) source[m] -= rate(k, m);
    for (int i = 0; i < 3; ++i)
      for (int m = 0; m < n; ++m) {
        const double slope = i == 0 ? -w(k, m) - w(k, n + m) : w(k, (i - 1) * n + m);
        double sum = sign * lambda(k, i * n + m) - slope;
        for (int j = 0; j < wide; ++j) sum += times(i, m, j) * source[j];
        density(k, i * n + m) = sum;
      }
    for (int m = 0; m < 2 * n; ++m) target(k, m) = -w(k, m);
  }
};

}  // namespace thixis::bound
