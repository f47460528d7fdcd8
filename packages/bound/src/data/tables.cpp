#include "data/tables.hpp"

#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {

std::vector<double> to_modal(const reference::CellBasis& basis, const reference::Modal& modal) {
  const int n = basis.size();
  std::vector<double> T(n * n, 0.0);
  const auto rule = reference::triangle_quadrature(2 * basis.degree());
  const auto psi = basis.tabulate(rule.size(), rule.point.data());
  const auto phi = modal.values(rule.size(), rule.point.data());
  for (int q = 0; q < rule.size(); ++q)
    for (int m = 0; m < n; ++m)
      for (int l = 0; l < n; ++l) T[m * n + l] += rule.weight[q] * phi[q * modal.size() + m] * psi.value[q * n + l];
  return T;
}

std::vector<double> from_moments(const reference::CellBasis& basis, const reference::Modal& modal) {
  // ∫ r psi_l = sum_m T_ml c_m
  const int n = basis.size();
  const auto inverse = reference::inverse(n, to_modal(basis, modal));
  std::vector<double> transposed(n * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) transposed[i * n + j] = inverse[j * n + i];
  return transposed;
}

std::vector<double> bernstein_lattice(const reference::Bernstein& B) {
  std::vector<double> points;
  for (int k = 0; k < B.size; ++k)
    for (int a = 0; a < 3; ++a) points.push_back(B.degree == 0 ? 1.0 / 3 : static_cast<double>(B.exponent[k][a]) / B.degree);
  return points;
}

std::vector<double> from_lattice(const reference::Bernstein& B) {
  const auto points = bernstein_lattice(B);
  std::vector<double> values(B.size * B.size);
  for (int k = 0; k < B.size; ++k) {
    const double lambda[3] = {points[3 * k], points[3 * k + 1], points[3 * k + 2]};
    B.values(lambda, &values[k * B.size]);
  }
  return reference::inverse(B.size, values);
}

std::vector<double> bernstein_to_modal(const reference::Bernstein& B, const reference::Modal& modal, int m) {
  std::vector<double> T(m * B.size, 0.0);
  const auto rule = reference::triangle_quadrature(B.degree + modal.degree());
  const auto phi = modal.values(rule.size(), rule.point.data());
  for (int q = 0; q < rule.size(); ++q) {
    const double xi = rule.point[2 * q], eta = rule.point[2 * q + 1], lambda[3] = {1 - xi - eta, xi, eta};
    double value[reference::max_functions];
    B.values(lambda, value);
    for (int i = 0; i < m; ++i)
      for (int k = 0; k < B.size; ++k) T[i * B.size + k] += rule.weight[q] * phi[q * modal.size() + i] * value[k];
  }
  return T;
}

Kokkos::View<const double***, Kokkos::LayoutRight> times_hats(int q) {
  const reference::Modal modal(q + 1);
  const int n = reference::dimension(q), wide = modal.size();
  const Kokkos::View<double***, Kokkos::LayoutRight> all("thixis::bound::times_hats", 3, n, wide);
  const auto host = Kokkos::create_mirror_view(all);
  for (int i = 0; i < 3; ++i)
    for (int m = 0; m < n; ++m)
      for (int k = 0; k < wide; ++k) host(i, m, k) = modal.times_barycentric(i)[m * wide + k];
  Kokkos::deep_copy(all, host);
  return all;
}

}  // namespace thixis::bound
