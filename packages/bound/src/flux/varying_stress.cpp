#include <algorithm>
#include <cmath>

#include "data/tables.hpp"
#include "flux/gradient_flux.hpp"

namespace thixis::bound {
namespace {

/// A rule for every cell with the tension and the modal polynomials at its points.
struct Points {
  method::CellQuadrature quadrature;
  View<const double*> mu, inverse;  ///< 1/mu from above
  Matrix at_rule, at_own;           ///< (point, mode)

  KOKKOS_INLINE_FUNCTION int count(LocalIndex k) const { return static_cast<int>(quadrature.offset(k + 1) - quadrature.offset(k)); }
  KOKKOS_INLINE_FUNCTION const double* phi(LocalIndex k, int q) const {
    const LocalIndex own = quadrature.own_rule(k);
    return own < 0 ? &at_rule(q, 0) : &at_own(quadrature.own_offset(own) + q, 0);
  }
  KOKKOS_INLINE_FUNCTION double weight(LocalIndex k, int q) const {
    const LocalIndex own = quadrature.own_rule(k);
    return own < 0 ? quadrature.rule_weight(q) : quadrature.own_weight(quadrature.own_offset(own) + q);
  }
  KOKKOS_INLINE_FUNCTION double tension(LocalIndex k, int q) const { return mu(quadrature.offset(k) + q); }
  KOKKOS_INLINE_FUNCTION double inverse_tension(LocalIndex k, int q) const { return inverse(quadrature.offset(k) + q); }
};

struct FillVarying {
  Gradient gradient;
  Points points;
  CellTable w;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int k) const {
    const int few = gradient.D.extent_int(0) / 2, n = w.extent_int(1) / 2;
    double g[2][most_modes];
    gradient(k, g[0], g[1]);
    for (int m = 0; m < 2 * n; ++m) w(k, m) = 0;
    for (int q = 0; q < points.count(k); ++q) {
      const double* const phi = points.phi(k, q);
      const double weighted = points.weight(k, q) * points.tension(k, q);
      for (int d = 0; d < 2; ++d) {
        double value = 0;
        for (int m = 0; m < few; ++m) value += g[d][m] * phi[m];
        for (int m = 0; m < n; ++m) w(k, d * n + m) += weighted * value * phi[m];
      }
    }
  }
};

/// ∫_K |mu grad u + sigma|²/mu by quadrature, of the part that is left by the solvers and of the whole.
struct VaryingNorms {
  Gradient gradient;
  Points points;
  Stress::Fluxes sigma;
  View<const double*> factor;  ///< mu^{-1/2} from above
  Stress::Norms norm;          ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int K) const {
    const int few = gradient.D.extent_int(0) / 2, n = sigma.disc.extent_int(1) / 2;
    const Metric& M = gradient.metric(K);
    double g[2][most_modes], disc[2][most_modes] = {}, rest[2][most_modes] = {}, sum[2] = {0, 0};
    gradient(K, g[0], g[1]);
    add(sigma.disc, K, disc);
    add(sigma.alg, K, rest);
    add(sigma.lin, K, rest);
    for (int q = 0; q < points.count(K); ++q) {
      const double* const phi = points.phi(K, q);
      const double mu = points.tension(K, q), weight = points.weight(K, q) * points.inverse_tension(K, q);
      double v[2][2] = {};
      for (int d = 0; d < 2; ++d) {
        double slope = 0;
        for (int m = 0; m < few; ++m) slope += g[d][m] * phi[m];
        for (int m = 0; m < n; ++m) {
          v[0][d] += disc[d][m] * phi[m];
          v[1][d] += rest[d][m] * phi[m];
        }
        v[0][d] += mu * slope;
        v[1][d] += v[0][d];
      }
      for (int i = 0; i < 2; ++i)
        sum[i] += weight * (M.G00 * v[i][0] * v[i][0] + 2 * M.G01 * v[i][0] * v[i][1] + M.G11 * v[i][1] * v[i][1]);
    }
    norm.disc(K) = norm_of(sum[0]);
    norm.whole(K) = norm_of(sum[1]);
    norm.alg(K) = factor(K) * size(sigma.alg, M, K);
    norm.lin(K) = factor(K) * size(sigma.lin, M, K);
  }
};

class VaryingStress final : public StressBase {
 public:
  VaryingStress(const method::Space& space, int q, const TensionBounds& bounds)
      : StressBase(space), factor_("thixis::bound::inverse_root_tension", owned_) {
    const auto host = Kokkos::create_mirror_view(factor_);
    for (LocalIndex K = 0; K < owned_; ++K) host(K) = 1 / std::sqrt(bounds.least[K]);
    Kokkos::deep_copy(factor_, host);
    const auto& quadrature = space.quadrature();
    const reference::Modal modal(std::max(q + 1, space.basis().degree()));
    const auto table = [&](const char* label, const View<const double* [2]>& points) {
      const auto xi = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), points);
      return matrix_view(label, xi.extent_int(0), modal.size(), modal.values(xi.extent_int(0), xi.data()));
    };
    points_ = {quadrature, bounds.at_points, bounds.inverse, table("thixis::bound::at_rule", quadrature.rule_xi),
               table("thixis::bound::at_own", quadrature.own_xi)};
  }
  void operator()(const method::Coefficients& u, const CellTable& w) const override {
    Kokkos::parallel_for("thixis::bound::stress_varying", Kokkos::RangePolicy<>(0, cells_), FillVarying{of(u), points_, w});
  }
  void norms(const method::Coefficients& u, const ConstCellTable&, const Fluxes& sigma, const Norms& norm) const override {
    Kokkos::parallel_for("thixis::bound::norms_varying", Kokkos::RangePolicy<>(0, owned_),
                         VaryingNorms{of(u), points_, sigma, factor_, norm});
  }
  void norms_between(const method::Coefficients& u, const ConstCellTable& w, const method::Coefficients& before, const ConstCellTable&,
                     const Fluxes& sigma, const Norms& norm, const View<double*>& change) const override {
    const method::Coefficients middle("thixis::bound::middle", u.extent(0)), difference("thixis::bound::difference", u.extent(0));
    Kokkos::parallel_for(
        "thixis::bound::between", Kokkos::RangePolicy<>(0, u.extent(0)), KOKKOS_LAMBDA(std::size_t e) {
          middle(e) = 0.5 * (u(e) + before(e));
          difference(e) = u(e) - before(e);
        });
    norms(difference, w, {}, norm);
    Kokkos::deep_copy(change, norm.disc);
    norms(middle, w, sigma, norm);
  }

 private:
  Points points_;
  View<double*> factor_;
};

}  // namespace

std::unique_ptr<Stress> varying_stress(const method::Space& space, int q, const TensionBounds& bounds) {
  return std::make_unique<VaryingStress>(space, q, bounds);
}

}  // namespace thixis::bound
