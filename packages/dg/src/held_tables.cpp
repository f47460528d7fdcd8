#include "held_boundary.hpp"
#include "thixis/reference/flux_moments.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::dg {

void HeldBoundary::tabulate() {
  const auto& basis = space_.basis();
  const int n = functions_, p = basis.degree(), size = width_ / 2;
  const reference::Modal modal(p + 1);
  const auto inside = reference::triangle_quadrature(2 * p + 1);
  const auto psi = basis.tabulate(inside.size(), inside.point.data()).value;
  const auto phi = modal.values(inside.size(), inside.point.data());
  divergence_.assign(n * width_, 0.0);
  for (int l = 0; l < n; ++l)
    for (int k = 0; k < reference::dimension(p); ++k) {
      double coefficient = 0;
      for (int q = 0; q < inside.size(); ++q) coefficient += inside.weight[q] * psi[q * n + l] * phi[q * size + k];
      for (int d = 0; d < 2; ++d)
        for (int m = 0; m < size; ++m) divergence_[l * width_ + d * size + m] += coefficient * modal.derivative(d)[k * size + m];
    }

  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const auto line = reference::line_quadrature(2 * p);
  const auto T = reference::from_moments(reference::RaviartThomas(p));
  const int count = static_cast<int>(T.size()) / width_;
  dual_.assign(3 * n * width_, 0.0);
  for (int f = 0; f < 3; ++f) {
    std::vector<int> on;
    for (int l = 0; l < n; ++l) {
      const auto& entity = basis.entities()[l];
      if ((entity.kind == reference::Entity::vertex && entity.index != f) || (entity.kind == reference::Entity::face && entity.index == f))
        on.push_back(l);
    }
    std::vector<double> moments((p + 1) * (p + 1), 0.0);  // (psi_m, L_j) on the face
    for (int q = 0; q < line.size(); ++q) {
      double at[2];
      for (int d = 0; d < 2; ++d) at[d] = (1 - line.point[q]) * corner[(f + 1) % 3][d] + line.point[q] * corner[(f + 2) % 3][d];
      const auto value = basis.tabulate(1, at).value, L = reference::legendre(p + 1, line.point[q]);
      for (int m = 0; m <= p; ++m)
        for (int j = 0; j <= p; ++j) moments[m * (p + 1) + j] += line.weight[q] * value[on[m]] * L[j];
    }
    const auto theta = reference::inverse(p + 1, moments);
    for (int l = 0; l <= p; ++l)
      for (int j = 0; j <= p; ++j)
        for (int r = 0; r < width_; ++r) dual_[(f * n + on[l]) * width_ + r] += theta[j * (p + 1) + l] * T[r * count + f * (p + 1) + j];
  }
}

}  // namespace thixis::dg
