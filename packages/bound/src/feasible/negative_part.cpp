#include "feasible/negative_part.hpp"

#include <cmath>

#include "thixis/method/cell_functions.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {

NegativePart negative_part(const reference::CellBasis& basis, const GradientProducts& products) {
  constexpr double corner[4][2] = {{0, 0}, {0.5, 0}, {0, 0.5}, {0.5, 0.5}};
  const reference::CellBasis bernstein(basis.degree(), reference::Family::bernstein);
  const int n = basis.size();
  NegativePart part;
  part.B = basis.bernstein();
  part.products = products;

  const reference::Bernstein& B = part.B;
  const auto index_of = [&](int e0, int e1) {
    for (int k = 0; k < n; ++k)
      if (B.exponent[k][0] == e0 && B.exponent[k][1] == e1) return k;
    return -1;
  };
  const View<int* [3]> corners("thixis::bound::corners", reference::dimension(B.degree - 1));
  const auto corners_host = Kokkos::create_mirror_view(corners);
  for (int e0 = 0, i = 0; e0 < B.degree; ++e0)
    for (int e1 = 0; e0 + e1 < B.degree; ++e1, ++i) {
      corners_host(i, 0) = index_of(e0 + 1, e1);
      corners_host(i, 1) = index_of(e0, e1 + 1);
      corners_host(i, 2) = index_of(e0, e1);
    }
  Kokkos::deep_copy(corners, corners_host);
  part.corners = corners;

  const Kokkos::View<double***, Kokkos::LayoutRight> halves("thixis::bound::halves", 4, n, n);
  const auto halves_host = Kokkos::create_mirror_view(halves);
  for (int i = 0; i < 4; ++i) {
    std::vector<double> at;
    for (int m = 0; m < n; ++m)
      for (int d = 0; d < 2; ++d) at.push_back(corner[i][d] + (i < 3 ? 0.5 : -0.5) * bernstein.points()[2 * m + d]);
    const auto table = bernstein.tabulate(n, at.data());
    for (int k = 0; k < n; ++k)
      for (int m = 0; m < n; ++m)
        for (int l = 0; l < n; ++l) halves_host(i, k, l) += bernstein.from_values()[k * n + m] * table.value[m * n + l];
    for (int k = 0; k < n; ++k)  // all are dyadic: binomials over 2^j, j <= 2p
      for (int l = 0; l < n; ++l) halves_host(i, k, l) = std::round(256 * halves_host(i, k, l)) / 256;
  }
  Kokkos::deep_copy(halves, halves_host);
  part.halves = halves;

  const auto rule = reference::triangle_quadrature(basis.degree() + max_density_degree);
  const View<double* [2]> xi("thixis::bound::part_xi", rule.size());
  const View<double*> weight("thixis::bound::part_weight", rule.size());
  const auto xi_host = Kokkos::create_mirror_view(xi);
  const auto weight_host = Kokkos::create_mirror_view(weight);
  for (int q = 0; q < rule.size(); ++q) {
    for (int d = 0; d < 2; ++d) xi_host(q, d) = rule.point[2 * q + d];
    weight_host(q) = rule.weight[q];
  }
  Kokkos::deep_copy(xi, xi_host);
  Kokkos::deep_copy(weight, weight_host);
  part.xi = xi;
  part.weight = weight;
  part.values = method::matrix_view("thixis::bound::part_values", rule.size(), n, bernstein.tabulate(rule.size(), rule.point.data()).value);
  return part;
}

}  // namespace thixis::bound
