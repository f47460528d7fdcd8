#include "data/cell_energy.hpp"

#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {

GradientProducts gradient_products(const reference::CellBasis& basis) {
  const reference::Bernstein& B = basis.bernstein();
  const int n = B.size;
  const auto rule = reference::triangle_quadrature(2 * B.degree);
  const View<double* [3]> Q("thixis::bound::gradient_products", n * n);
  const auto host = Kokkos::create_mirror_view(Q);
  for (int q = 0; q < rule.size(); ++q) {
    const double xi = rule.point[2 * q], eta = rule.point[2 * q + 1], lambda[3] = {1 - xi - eta, xi, eta};
    double dB[reference::max_functions][3];
    B.derivatives(lambda, dB);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double di[2] = {dB[i][1] - dB[i][0], dB[i][2] - dB[i][0]}, dj[2] = {dB[j][1] - dB[j][0], dB[j][2] - dB[j][0]};
        host(i * n + j, 0) += rule.weight[q] * di[0] * dj[0];
        host(i * n + j, 1) += rule.weight[q] * (di[0] * dj[1] + di[1] * dj[0]);
        host(i * n + j, 2) += rule.weight[q] * di[1] * dj[1];
      }
  }
  Kokkos::deep_copy(Q, host);
  return Q;
}

}  // namespace thixis::bound
