#pragma once
#include "data/cell_energy.hpp"
#include "data/density.hpp"

namespace thixis::bound {

/// Bounds from above on integrals over {g < 0} in a cell, for polynomials g in Bernstein coefficients. The cell is cut into four (red)
/// `levels` times where the coefficients have both signs. A part with coefficients >= 0 (up to round-off) gives nothing, one with
/// coefficients <= 0 counts fully, in what is mixed at last g >= l - d with a linear function l, so that
///
///     square:   ∫_{g<0} |grad g|²        <=  min(∫ |grad g|²,  |{l < d}| max |grad g|²),
///     moment:   ∫ density max(-g, 0)     <=  ∫ density (sum_k max(-c_k, 0) B_k).
///
/// Parts whose square is negligible are cut no further than twice, as long as their moment is not.
struct NegativePart {
  static constexpr int levels = 5;

  reference::Bernstein B;
  GradientProducts products;
  View<const int* [3]> corners;                               ///< coefficients whose differences are those of the gradient
  Kokkos::View<const double***, Kokkos::LayoutRight> halves;  ///< (part, k, l): Bernstein coefficients in the four parts (de Casteljau)
  View<const double* [2]> xi;                                 ///< a rule that is exact for density times polynomial
  View<const double*> weight;
  Matrix values;  ///< (point, k): B_k

  struct Bounds {
    double square = 0, moment = 0;
  };
  /// `a`: monomials of the density, null where it is 0. `cuts`: how often the cell may be cut, at most `levels`. `small`: what is
  /// negligible. `round_off`: of the coefficients. Corners of parts are nodes, where gaps are closed; its sign is not to decide whether a
  /// part counts.
  KOKKOS_FUNCTION Bounds operator()(const mesh::CellGeometry& K, const double* c, const DensityValues& density, const double* a, int cuts,
                                    const Bounds& small, double round_off) const {
    const int n = B.size;
    double largest_density = 0;
    for (int i = 0; a && i < reference::dimension(density.degree); ++i) largest_density += a[i] < 0 ? -a[i] : a[i];
    Part stack[3 * levels + 1];
    int top = 0;
    for (int k = 0; k < n; ++k) stack[0].c[k] = c[k];
    stack[0].cuts = cuts;
    double negligible = 0;
    Bounds bounds;
    while (top >= 0) {
      const Part part = stack[top--];
      double low = part.c[0], high = part.c[0];
      for (int k = 1; k < n; ++k) {
        low = part.c[k] < low ? part.c[k] : low;
        high = part.c[k] > high ? part.c[k] : high;
      }
      if (low >= -round_off) {
        if (a && low < 0) bounds.moment += moment(part, density, a);
        continue;
      }
      double square = gradient_square(products, K, n, part.c);
      if (part.cuts == cuts) negligible = 1e-4 * square;
      if (high > round_off) {
        const double some = steepest(K, part) * share_below(part);
        square = some < square ? some : square;
        const bool for_moment = part.cuts > cuts - 2 && -low * largest_density * 0.5 * part.scale * part.scale > small.moment;
        if (part.cuts > 0 && square > negligible && (square > small.square || for_moment)) {
          for (int i = 0; i < 4; ++i) child(part, i, stack[++top]);
          continue;
        }
      }
      bounds.square += square;
      if (a) bounds.moment += moment(part, density, a);
    }
    return bounds;
  }

 private:
  /// The part is {origin + scale xi}: the middle ones of red refinement are turned, scale < 0.
  struct Part {
    double c[reference::max_functions];
    double origin[2] = {0, 0}, scale = 1;
    int cuts = 0;
  };
  KOKKOS_FUNCTION void child(const Part& part, int i, Part& out) const {
    constexpr double corner[4][2] = {{0, 0}, {0.5, 0}, {0, 0.5}, {0.5, 0.5}};
    for (int d = 0; d < 2; ++d) out.origin[d] = part.origin[d] + part.scale * corner[i][d];
    out.scale = (i < 3 ? 0.5 : -0.5) * part.scale;
    out.cuts = part.cuts - 1;
    for (int k = 0; k < B.size; ++k) {
      out.c[k] = 0;
      for (int l = 0; l < B.size; ++l) out.c[k] += halves(i, k, l) * part.c[l];
    }
  }
  /// |part| max |grad g|²: the gradient lies between its Bernstein coefficients.
  KOKKOS_FUNCTION double steepest(const mesh::CellGeometry& K, const Part& part) const {
    double most = 0;
    for (int i = 0; i < corners.extent_int(0); ++i) {
      const double a = part.c[corners(i, 1)] - part.c[corners(i, 0)], b = part.c[corners(i, 2)] - part.c[corners(i, 0)];
      const double x = a * K.gradient[1][0] + b * K.gradient[2][0], y = a * K.gradient[1][1] + b * K.gradient[2][1];
      most = x * x + y * y > most ? x * x + y * y : most;
    }
    return K.area * B.degree * B.degree * most;
  }
  /// |{l < d}| / |part| for the linear interpolant l of the corners, d the largest of its coefficients over those of g.
  KOKKOS_FUNCTION double share_below(const Part& part) const {
    double v[3] = {0, 0, 0}, d = 0;
    for (int k = 0; k < B.size; ++k)
      for (int a = 0; a < 3; ++a)
        if (B.exponent[k][a] == B.degree) v[a] = part.c[k];
    for (int k = 0; k < B.size; ++k) {
      double linear = 0;
      for (int a = 0; a < 3; ++a) linear += B.exponent[k][a] * v[a] / B.degree;
      d = linear - part.c[k] > d ? linear - part.c[k] : d;
    }
    int below = 0;
    for (double& value : v) below += (value -= d) < 0;
    if (below == 0 || below == 3) return below == 3 ? 1 : 0;
    for (int a = 0; a < 3; ++a)  // the corner that is alone on its side
      if ((v[a] < 0) == (below == 1)) {
        const double cut = v[a] / (v[a] - v[(a + 1) % 3]) * (v[a] / (v[a] - v[(a + 2) % 3]));
        return below == 1 ? cut : 1 - cut;
      }
    return 1;
  }
  KOKKOS_FUNCTION double moment(const Part& part, const DensityValues& density, const double* a) const {
    double sum = 0;
    for (int q = 0; q < weight.extent_int(0); ++q) {
      double below = 0;
      for (int k = 0; k < B.size; ++k) below -= part.c[k] < 0 ? values(q, k) * part.c[k] : 0;
      sum += weight(q) * below * density.value(a, part.origin[0] + part.scale * xi(q, 0), part.origin[1] + part.scale * xi(q, 1));
    }
    return part.scale * part.scale * sum;
  }
};

NegativePart negative_part(const reference::CellBasis& basis, const GradientProducts& products);

}  // namespace thixis::bound
