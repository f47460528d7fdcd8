#include "stress.hpp"

#include <algorithm>

#include "tables.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::equilibration {
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

/// |w + sigma|_K / √mu
struct Distance {
  ConstCellTable w, sigma;
  Metrics metric;
  double factor;
  View<double*> norm;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int K) const {
    const int n = w.extent_int(1) / 2, m = sigma.extent_int(1) / 2;
    double v[2][most_modes];
    for (int d = 0; d < 2; ++d)
      for (int i = 0; i < m; ++i) v[d][i] = sigma(K, d * m + i) + (i < n ? w(K, d * n + i) : 0);
    const double square = metric(K).square(v[0], v[1], m);
    norm(K) = factor * Kokkos::Experimental::sqrt(square > 0 ? square : 0);
  }
};

struct Size {
  ConstCellTable sigma;
  Metrics metric;
  View<const double*> factor;  ///< mu^{-1/2}
  View<double*> norm;          ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int K) const {
    const int m = sigma.extent_int(1) / 2;
    const double square = metric(K).square(&sigma(K, 0), &sigma(K, m), m);
    norm(K) = factor(K) * Kokkos::Experimental::sqrt(square > 0 ? square : 0);
  }
};

class StressBase : public Stress {
 public:
  StressBase(const method::PolynomialSpace& space, const std::vector<double>& least)
      : gradient_{space.coefficients().element_entries,
                  {},
                  matrix("thixis::equilibration::gradient", 2 * reference::dimension(space.basis().degree() - 1), space.basis().size(),
                         reference_gradient(space.basis())),
                  metrics(space.mesh(), space.cells())},
        cells_(space.cells().extent_int(0)),
        owned_(space.mesh().owned_cells),
        factor_("thixis::equilibration::inverse_root_tension", owned_) {
    const auto host = Kokkos::create_mirror_view(factor_);
    for (LocalIndex K = 0; K < owned_; ++K) host(K) = 1 / std::sqrt(least[K]);
    Kokkos::deep_copy(factor_, host);
  }
  void size(const ConstCellTable& sigma, const View<double*>& norm) const override {
    Kokkos::parallel_for("thixis::equilibration::flux_size", Kokkos::RangePolicy<>(0, owned_),
                         Size{sigma, gradient_.metric, factor_, norm});
  }

 protected:
  Gradient of(const method::Coefficients& u) const {
    Gradient gradient = gradient_;
    gradient.u = u;
    return gradient;
  }
  Gradient gradient_;
  LocalIndex cells_, owned_;
  View<double*> factor_;
};

class ConstantStress final : public StressBase {
 public:
  ConstantStress(const method::PolynomialSpace& space, double mu, const std::vector<double>& least) : StressBase(space, least), mu_(mu) {}
  void operator()(const method::Coefficients& u, const CellTable& w) const override {
    Kokkos::parallel_for("thixis::equilibration::stress", Kokkos::RangePolicy<>(0, cells_), FillConstant{of(u), mu_, w});
  }
  void distance(const method::Coefficients&, const ConstCellTable& w, const ConstCellTable& sigma,
                const View<double*>& norm) const override {
    Kokkos::parallel_for("thixis::equilibration::distance", Kokkos::RangePolicy<>(0, owned_),
                         Distance{w, sigma, gradient_.metric, 1 / std::sqrt(mu_), norm});
  }

 private:
  double mu_;
};

/// A rule for every cell with the tension and the modal polynomials at its points.
struct Points {
  method::CellQuadrature quadrature;
  View<const double*> mu;
  Matrix at_rule, at_own;  ///< (point, mode)

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

/// ∫_K |mu grad u + sigma|²/mu
struct DistanceVarying {
  Gradient gradient;
  Points points;
  ConstCellTable sigma;
  View<double*> norm;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int K) const {
    const int few = gradient.D.extent_int(0) / 2, n = sigma.extent_int(1) / 2;
    const Metric& M = gradient.metric(K);
    double g[2][most_modes], sum = 0;
    gradient(K, g[0], g[1]);
    for (int q = 0; q < points.count(K); ++q) {
      const double* const phi = points.phi(K, q);
      const double mu = points.tension(K, q);
      double v[2];
      for (int d = 0; d < 2; ++d) {
        double slope = 0;
        v[d] = 0;
        for (int m = 0; m < few; ++m) slope += g[d][m] * phi[m];
        for (int m = 0; m < n; ++m) v[d] += sigma(K, d * n + m) * phi[m];
        v[d] += mu * slope;
      }
      sum += points.weight(K, q) / mu * (M.G00 * v[0] * v[0] + 2 * M.G01 * v[0] * v[1] + M.G11 * v[1] * v[1]);
    }
    norm(K) = Kokkos::Experimental::sqrt(sum > 0 ? sum : 0);
  }
};

class VaryingStress final : public StressBase {
 public:
  VaryingStress(const method::PolynomialSpace& space, int q, const scene::Field& tension, const std::vector<double>& least)
      : StressBase(space, least) {
    const auto& quadrature = space.quadrature();
    const reference::Modal modal(std::max(q + 1, space.basis().degree()));
    const auto table = [&](const std::string& label, const View<const double* [2]>& points) {
      const auto xi = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), points);
      return matrix(label, xi.extent_int(0), modal.size(), modal.values(xi.extent_int(0), xi.data()));
    };
    points_ = {quadrature, method::tension_at_points(space.mesh(), quadrature, tension),
               table("thixis::equilibration::at_rule", quadrature.rule_xi), table("thixis::equilibration::at_own", quadrature.own_xi)};
  }
  void operator()(const method::Coefficients& u, const CellTable& w) const override {
    Kokkos::parallel_for("thixis::equilibration::stress_varying", Kokkos::RangePolicy<>(0, cells_), FillVarying{of(u), points_, w});
  }
  void distance(const method::Coefficients& u, const ConstCellTable&, const ConstCellTable& sigma,
                const View<double*>& norm) const override {
    Kokkos::parallel_for("thixis::equilibration::distance_varying", Kokkos::RangePolicy<>(0, owned_),
                         DistanceVarying{of(u), points_, sigma, norm});
  }

 private:
  Points points_;
};

}  // namespace

std::unique_ptr<Stress> make_stress(const method::PolynomialSpace& space, int q, const scene::Field& tension,
                                    const std::vector<double>& least) {
  if (const double* constant = tension.constant()) return std::make_unique<ConstantStress>(space, *constant, least);
  return std::make_unique<VaryingStress>(space, q, tension, least);
}

}  // namespace thixis::equilibration
