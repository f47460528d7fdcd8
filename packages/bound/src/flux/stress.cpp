#include "flux/stress.hpp"

#include <algorithm>

#include "data/tables.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::bound {
namespace {

using Entries = Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>;
constexpr int most_modes = reference::dimension(5);

/// (d dim P_{p-1} + m, l): modal coefficients of d psi_l/d xi_d.
std::vector<double> reference_gradient(const reference::CellBasis& basis) {
  const reference::Modal modal(basis.degree());
  const int n = basis.size(), few = reference::dimension(basis.degree() - 1);
  const auto T = to_modal(basis, modal);
  std::vector<double> D(2 * few * n, 0.0);
  for (int d = 0; d < 2; ++d)
    for (int m = 0; m < few; ++m)
      for (int k = 0; k < n; ++k)
        for (int l = 0; l < n; ++l) D[(d * few + m) * n + l] += modal.derivative(d)[m * n + k] * T[k * n + l];
  return D;
}

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

KOKKOS_INLINE_FUNCTION double root(double square) { return Kokkos::Experimental::sqrt(square > 0 ? square : 0); }

/// v += sigma(K, ·), which may be of length 0.
KOKKOS_INLINE_FUNCTION void add(const ConstCellTable& sigma, int K, double (&v)[2][most_modes]) {
  const int m = sigma.extent_int(1) / 2;
  for (int d = 0; d < 2; ++d)
    for (int i = 0; i < m; ++i) v[d][i] += sigma(K, d * m + i);
}

KOKKOS_INLINE_FUNCTION double size(const ConstCellTable& sigma, const Metric& metric, int K) {
  const int m = sigma.extent_int(1) / 2;
  return m == 0 ? 0 : root(metric.square(&sigma(K, 0), &sigma(K, m), m));
}

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
      change(K) = factor * root(M.square(c[0], c[1], n));
    }
    norm.disc(K) = factor * root(M.square(v[0], v[1], m));
    add(sigma.alg, K, v);
    add(sigma.lin, K, v);
    norm.whole(K) = factor * root(M.square(v[0], v[1], m));
    norm.alg(K) = factor * size(sigma.alg, M, K);
    norm.lin(K) = factor * size(sigma.lin, M, K);
  }
};

class StressBase : public Stress {
 public:
  explicit StressBase(const method::PolynomialSpace& space)
      : gradient_{space.coefficients().element_entries,
                  {},
                  matrix("thixis::bound::gradient", 2 * reference::dimension(space.basis().degree() - 1), space.basis().size(),
                         reference_gradient(space.basis())),
                  metrics(space.mesh(), space.cells())},
        cells_(space.cells().extent_int(0)),
        owned_(space.mesh().owned_cells) {}

 protected:
  Gradient of(const method::Coefficients& u) const {
    Gradient gradient = gradient_;
    gradient.u = u;
    return gradient;
  }
  Gradient gradient_;
  LocalIndex cells_, owned_;
};

class ConstantStress final : public StressBase {
 public:
  ConstantStress(const method::PolynomialSpace& space, double mu) : StressBase(space), mu_(mu) {}
  void operator()(const method::Coefficients& u, const CellTable& w) const override {
    Kokkos::parallel_for("thixis::bound::stress", Kokkos::RangePolicy<>(0, cells_), FillConstant{of(u), mu_, w});
  }
  void norms(const method::Coefficients&, const ConstCellTable& w, const Fluxes& sigma, const Norms& norm) const override {
    Kokkos::parallel_for("thixis::bound::norms", Kokkos::RangePolicy<>(0, owned_),
                         ConstantNorms{w, sigma, gradient_.metric, 1 / std::sqrt(mu_), norm, {}, {}});
  }
  void norms_between(const method::Coefficients&, const ConstCellTable& w, const method::Coefficients&, const ConstCellTable& w_before,
                     const Fluxes& sigma, const Norms& norm, const View<double*>& change) const override {
    Kokkos::parallel_for("thixis::bound::norms_between", Kokkos::RangePolicy<>(0, owned_),
                         ConstantNorms{w, sigma, gradient_.metric, 1 / std::sqrt(mu_), norm, w_before, change});
  }

 private:
  double mu_;
};

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
    norm.disc(K) = root(sum[0]);
    norm.whole(K) = root(sum[1]);
    norm.alg(K) = factor(K) * size(sigma.alg, M, K);
    norm.lin(K) = factor(K) * size(sigma.lin, M, K);
  }
};

class VaryingStress final : public StressBase {
 public:
  VaryingStress(const method::PolynomialSpace& space, int q, const TensionBounds& bounds)
      : StressBase(space), factor_("thixis::bound::inverse_root_tension", owned_) {
    const auto host = Kokkos::create_mirror_view(factor_);
    for (LocalIndex K = 0; K < owned_; ++K) host(K) = 1 / std::sqrt(bounds.least[K]);
    Kokkos::deep_copy(factor_, host);
    const auto& quadrature = space.quadrature();
    const reference::Modal modal(std::max(q + 1, space.basis().degree()));
    const auto table = [&](const std::string& label, const View<const double* [2]>& points) {
      const auto xi = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), points);
      return matrix(label, xi.extent_int(0), modal.size(), modal.values(xi.extent_int(0), xi.data()));
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

std::unique_ptr<Stress> make_stress(const method::PolynomialSpace& space, int q, const scene::Field& tension, const TensionBounds& bounds) {
  if (const double* constant = tension.constant()) return std::make_unique<ConstantStress>(space, *constant);
  return std::make_unique<VaryingStress>(space, q, bounds);
}

}  // namespace thixis::bound
