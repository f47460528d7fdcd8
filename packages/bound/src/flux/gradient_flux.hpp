#pragma once
#include "flux/stress.hpp"

/// What stresses of constant and of varying tensions share.
namespace thixis::bound {

using Entries = Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>;
constexpr int most_modes = reference::dimension(5);

/// ŵ = G^{-1} grad^ û, det G = 1: the flux of grad u.
struct Gradient {
  Entries entries;
  method::Coefficients u;
  Matrix D;
  Metrics metric;

  KOKKOS_INLINE_FUNCTION void operator()(int k, double* w0, double* w1) const {
    const int few = D.extent_int(0) / 2, n = D.extent_int(1);
    const Metric& M = metric(k);
    double c[reference::max_functions];
    for (int l = 0; l < n; ++l) c[l] = u(entries(k, l));
    for (int m = 0; m < few; ++m) {
      double d0 = 0, d1 = 0;
      for (int l = 0; l < n; ++l) {
        d0 += D(m, l) * c[l];
        d1 += D(few + m, l) * c[l];
      }
      w0[m] = M.G11 * d0 - M.G01 * d1;
      w1[m] = M.G00 * d1 - M.G01 * d0;
    }
  }
};

/// Of a square that round-off may have taken below zero.
KOKKOS_INLINE_FUNCTION double norm_of(double square) { return Kokkos::Experimental::sqrt(square > 0 ? square : 0); }

/// v += sigma(K, ·), which may be of length 0.
KOKKOS_INLINE_FUNCTION void add(const ConstCellTable& sigma, int K, double (&v)[2][most_modes]) {
  const int m = sigma.extent_int(1) / 2;
  for (int d = 0; d < 2; ++d)
    for (int i = 0; i < m; ++i) v[d][i] += sigma(K, d * m + i);
}

KOKKOS_INLINE_FUNCTION double size(const ConstCellTable& sigma, const Metric& metric, int K) {
  const int m = sigma.extent_int(1) / 2;
  return m == 0 ? 0 : norm_of(metric.square(&sigma(K, 0), &sigma(K, m), m));
}

class StressBase : public Stress {
 public:
  explicit StressBase(const method::Space& space);

 protected:
  Gradient of(const method::Coefficients& u) const {
    Gradient gradient = gradient_;
    gradient.u = u;
    return gradient;
  }
  Gradient gradient_;
  LocalIndex cells_, owned_;
};

std::unique_ptr<Stress> constant_stress(const method::Space& space, double mu);
/// By the quadrature of the space.
std::unique_ptr<Stress> varying_stress(const method::Space& space, int q, const TensionBounds& bounds);

}  // namespace thixis::bound
