#include <cmath>

#include "flux/gradient_flux.hpp"

namespace thixis::bound {
namespace {

struct FillConstant {
  Gradient gradient;
  double mu;
  CellTable w;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int k) const {
    const int few = gradient.D.extent_int(0) / 2, n = w.extent_int(1) / 2;
    double w0[most_modes], w1[most_modes];
    gradient(k, w0, w1);
    for (int m = 0; m < n; ++m) {
      w(k, m) = m < few ? mu * w0[m] : 0;
      w(k, n + m) = m < few ? mu * w1[m] : 0;
    }
  }
};

struct ConstantNorms {
  ConstCellTable w;
  Stress::Fluxes sigma;
  Metrics metric;
  double factor;       ///< mu^{-1/2}
  Stress::Norms norm;  ///< out, overwritten
  ConstCellTable w_before;
  View<double*> change;  ///< out, overwritten; of length 0: w alone counts, and not the mean of both
  KOKKOS_FUNCTION void operator()(int K) const {
    const int n = w.extent_int(1) / 2, m = sigma.disc.extent_int(1) / 2;
    const Metric M = metric(K);
    const bool between = change.extent(0) > 0;
    double v[2][most_modes], c[2][most_modes];
    for (int d = 0; d < 2; ++d)
      for (int i = 0; i < m; ++i) v[d][i] = sigma.disc(K, d * m + i) + (i < n ? w(K, d * n + i) : 0);
    if (between) {
      for (int d = 0; d < 2; ++d)
        for (int i = 0; i < n; ++i) {
          c[d][i] = w(K, d * n + i) - w_before(K, d * n + i);
          v[d][i] -= 0.5 * c[d][i];
        }
      change(K) = factor * norm_of(M.square(c[0], c[1], n));
    }
    norm.disc(K) = factor * norm_of(M.square(v[0], v[1], m));
    add(sigma.alg, K, v);
    add(sigma.lin, K, v);
    norm.whole(K) = factor * norm_of(M.square(v[0], v[1], m));
    norm.alg(K) = factor * size(sigma.alg, M, K);
    norm.lin(K) = factor * size(sigma.lin, M, K);
  }
};

class ConstantStress final : public StressBase {
 public:
  ConstantStress(const method::Space& space, double mu) : StressBase(space), mu_(mu) {}
  void operator()(const method::Coefficients& u, const CellTable& w) const override {
    Kokkos::parallel_for("thixis::bound::stress", Kokkos::RangePolicy<>(0, cells_), FillConstant{of(u), mu_, w});
  }
  void norms(const method::Coefficients&, const ConstCellTable& w, const Fluxes& sigma, const Norms& norm) const override {
    Kokkos::parallel_for("thixis::bound::norms", Kokkos::RangePolicy<>(0, owned_), norms_of(w, sigma, norm));
  }
  void norms_between(const method::Coefficients&, const ConstCellTable& w, const method::Coefficients&, const ConstCellTable& w_before,
                     const Fluxes& sigma, const Norms& norm, const View<double*>& change) const override {
    ConstantNorms between = norms_of(w, sigma, norm);
    between.w_before = w_before;
    between.change = change;
    Kokkos::parallel_for("thixis::bound::norms_between", Kokkos::RangePolicy<>(0, owned_), between);
  }

 private:
  ConstantNorms norms_of(const ConstCellTable& w, const Fluxes& sigma, const Norms& norm) const {
    ConstantNorms norms;
    norms.w = w;
    norms.sigma = sigma;
    norms.metric = gradient_.metric;
    norms.factor = 1 / std::sqrt(mu_);
    norms.norm = norm;
    return norms;
  }
  double mu_;
};

}  // namespace

std::unique_ptr<Stress> constant_stress(const method::Space& space, double mu) { return std::make_unique<ConstantStress>(space, mu); }

}  // namespace thixis::bound
