#pragma once
#include "thixis/bound/cell_fields.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/reference/cell_basis.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::bound {

/// Products of the gradients of Bernstein polynomials on the reference triangle, integrated: (i n + j, …) those of the derivatives in xi,
/// the mixed ones, those in eta.
using GradientProducts = View<const double* [3]>;
GradientProducts gradient_products(const reference::CellBasis& basis);

/// ∫_K |grad v|² of a polynomial in Bernstein coefficients c.
KOKKOS_INLINE_FUNCTION double gradient_square(const GradientProducts& Q, const mesh::CellGeometry& K, int n, const double* c) {
  double s[3] = {0, 0, 0};
  for (int i = 0; i < n; ++i) {
    double row[3] = {0, 0, 0};
    for (int j = 0; j < n; ++j)
      for (int m = 0; m < 3; ++m) row[m] += Q(i * n + j, m) * c[j];
    for (int m = 0; m < 3; ++m) s[m] += c[i] * row[m];
  }
  const double* const a = K.gradient[1];
  const double* const b = K.gradient[2];
  return 2 * K.area * (s[0] * (a[0] * a[0] + a[1] * a[1]) + s[1] * (a[0] * b[0] + a[1] * b[1]) + s[2] * (b[0] * b[0] + b[1] * b[1]));
}

/// The points of the cell at position k of a quadrature, seen from a kernel.
struct PointsOf {
  const method::CellQuadrature& Q;
  LocalIndex rule;
  GlobalIndex first;  ///< in the numbering of all points
  int count;
  KOKKOS_FUNCTION PointsOf(const method::CellQuadrature& quadrature, LocalIndex k)
      : Q(quadrature), rule(Q.own_rule(k)), first(Q.offset(k)), count(static_cast<int>(Q.offset(k + 1) - first)) {}
  KOKKOS_FUNCTION double xi(int q, int d) const { return rule < 0 ? Q.rule_xi(q, d) : Q.own_xi(Q.own_offset(rule) + q, d); }
  KOKKOS_FUNCTION double weight(int q) const { return rule < 0 ? Q.rule_weight(q) : Q.own_weight(Q.own_offset(rule) + q); }  ///< sum: 1/2
};

/// mu_alpha for kernels: a constant, or the values at the points of a quadrature over the patch cells.
struct Tension {
  double constant[2] = {0, 0};
  View<const double*> at_points[2];

  KOKKOS_FUNCTION bool varies(int alpha) const { return at_points[alpha].extent(0) > 0; }
  KOKKOS_FUNCTION double operator()(int alpha, GlobalIndex point) const {
    return varies(alpha) ? at_points[alpha](point) : constant[alpha];
  }
};

/// |||v|||²_K = ∫_K mu_alpha |grad v|² of polynomials in Bernstein coefficients: exact for constant tensions, by quadrature for others.
struct CellEnergy {
  reference::Bernstein B;
  GradientProducts products;
  method::CellQuadrature quadrature;
  Tension mu;

  KOKKOS_FUNCTION double operator()(int alpha, LocalIndex k, const mesh::CellGeometry& K, const double* c) const {
    if (!mu.varies(alpha)) return mu.constant[alpha] * gradient_square(products, K, B.size, c);
    const PointsOf points(quadrature, k);
    double sum = 0;
    for (int q = 0; q < points.count; ++q) {
      const double xi = points.xi(q, 0), eta = points.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
      double slope[3], g[2] = {0, 0};
      B.gradient(c, lambda, slope);
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) g[d] += slope[a] * K.gradient[a][d];
      sum += 2 * K.area * points.weight(q) * mu(alpha, points.first + q) * (g[0] * g[0] + g[1] * g[1]);
    }
    return sum;
  }
};

}  // namespace thixis::bound
