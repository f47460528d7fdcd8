#pragma once
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/reference/bernstein.hpp"

namespace thixis::method {

/// P = Π(mu g) in P_m(K)², (P, w)_K = (mu g, w)_K for all w in P_m(K)², with the quadrature of the form where mu varies, for kernels.
/// In modal coefficients of the reference triangle: g like a gradient, ĝ = DF^T g∘F, and P like a flux, P̂ = det DF^{-1} P∘F, so that
///
///     P̂ = Π(mu G^{-1} ĝ),   G^{-1} = det DF^{-1} DF^{-T},   (G^{-1})_ab = 2|K| grad(lambda_a+1)·grad(lambda_b+1).
struct FluxDensity {
  static constexpr int most = 10;  ///< dim P_3
  using Coefficients = double[2][most];

  CellQuadrature quadrature;
  reference::Bernstein B;                               ///< of degree m
  Kokkos::View<const double**, Kokkos::LayoutRight> C;  ///< (k, l): phi_l = sum_k C_kl B_k
  double constant = 0;                                  ///< the tension where mu is empty
  View<const double*> mu;                               ///< at all points of the quadrature

  KOKKOS_INLINE_FUNCTION int size() const { return B.size; }

  /// P on the cell K at position k of the quadrature; returns the mean of mu.
  KOKKOS_INLINE_FUNCTION double operator()(LocalIndex k, const mesh::CellGeometry& K, const Coefficients& g, Coefficients& P) const {
    double moment[2][most];
    const double mean = mu.extent(0) == 0 ? scaled(g, moment) : weighted(k, g, moment);
    for (int a = 0; a < 2; ++a) {
      const double* const da = K.gradient[a + 1];
      for (int l = 0; l < B.size; ++l) P[a][l] = 0;
      for (int b = 0; b < 2; ++b) {
        const double* const db = K.gradient[b + 1];
        const double G = 2 * K.area * (da[0] * db[0] + da[1] * db[1]);
        for (int l = 0; l < B.size; ++l) P[a][l] += G * moment[b][l];
      }
    }
    return mean;
  }

 private:
  KOKKOS_INLINE_FUNCTION double scaled(const Coefficients& g, Coefficients& moment) const {
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < B.size; ++l) moment[d][l] = constant * g[d][l];
    return constant;
  }

  /// moment[d][l] = ∫ mu ĝ_d phi_l.
  KOKKOS_INLINE_FUNCTION double weighted(LocalIndex k, const Coefficients& g, Coefficients& moment) const {
    const LocalIndex own = quadrature.own_rule(k);
    const int m = B.size, points = static_cast<int>(quadrature.offset(k + 1) - quadrature.offset(k));
    double of_B[2][most] = {}, c[2][most], value[most], integral = 0, area = 0;
    for (int d = 0; d < 2; ++d)
      for (int i = 0; i < m; ++i) {
        c[d][i] = 0;
        for (int l = 0; l < m; ++l) c[d][i] += C(i, l) * g[d][l];
      }
    for (int q = 0; q < points; ++q) {
      const GlobalIndex at = own < 0 ? q : quadrature.own_offset(own) + q;
      const double xi = own < 0 ? quadrature.rule_xi(at, 0) : quadrature.own_xi(at, 0);
      const double eta = own < 0 ? quadrature.rule_xi(at, 1) : quadrature.own_xi(at, 1);
      const double weight = own < 0 ? quadrature.rule_weight(at) : quadrature.own_weight(at);
      const double tension = weight * mu(quadrature.offset(k) + q), lambda[3] = {1 - xi - eta, xi, eta};
      area += weight;
      integral += tension;
      B.values(lambda, value);
      for (int d = 0; d < 2; ++d) {
        double sum = 0;
        for (int i = 0; i < m; ++i) sum += c[d][i] * value[i];
        for (int i = 0; i < m; ++i) of_B[d][i] += tension * sum * value[i];
      }
    }
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < m; ++l) {
        moment[d][l] = 0;
        for (int i = 0; i < m; ++i) moment[d][l] += C(i, l) * of_B[d][i];
      }
    return integral / area;
  }
};

/// Of polynomials of this degree. Collective; throws InputError where the tension is not positive.
FluxDensity flux_density(const mesh::Mesh& mesh, const CellQuadrature& quadrature, int degree, const scene::Field& tension);

}  // namespace thixis::method
