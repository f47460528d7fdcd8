#include <array>

#include "face_form.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::dg {
namespace {

constexpr int most = reference::max_functions;

}  // namespace

Traces traces(const reference::CellBasis& basis, int order) {
  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const auto rule = reference::line_quadrature(order);
  const int n = basis.size(), points = rule.size(), p = basis.degree();
  View<double*> t("thixis::dg::points", points), weight("thixis::dg::weights", points);
  Kokkos::View<double***, Kokkos::LayoutRight> value("thixis::dg::traces", 6, points, n);
  Kokkos::View<double*** [3], Kokkos::LayoutRight> derivative("thixis::dg::trace_derivatives", 6, points, n);
  Kokkos::View<int**, Kokkos::LayoutRight> on_face("thixis::dg::on_face", 3, p + 1);
  const auto t_host = Kokkos::create_mirror_view(t), weight_host = Kokkos::create_mirror_view(weight);
  const auto value_host = Kokkos::create_mirror_view(value);
  const auto derivative_host = Kokkos::create_mirror_view(derivative);
  const auto on_host = Kokkos::create_mirror_view(on_face);
  for (int q = 0; q < points; ++q) {
    t_host(q) = rule.point[q];
    weight_host(q) = rule.weight[q];
  }
  for (int f = 0; f < 3; ++f) {
    for (int back = 0; back < 2; ++back)
      for (int q = 0; q < points; ++q) {
        const double s = back ? 1 - rule.point[q] : rule.point[q];
        double at[2], B[most], dB[most][3];
        for (int d = 0; d < 2; ++d) at[d] = (1 - s) * corner[(f + 1) % 3][d] + s * corner[(f + 2) % 3][d];
        const double lambda[3] = {1 - at[0] - at[1], at[0], at[1]};
        basis.bernstein().values(lambda, B);
        basis.bernstein().derivatives(lambda, dB);
        for (int i = 0; i < n; ++i)
          for (int k = 0; k < n; ++k) {
            const double c = basis.to_bernstein()[k * n + i];
            value_host(2 * f + back, q, i) += c * B[k];
            for (int a = 0; a < 3; ++a) derivative_host(2 * f + back, q, i, a) += c * dB[k][a];
          }
      }
    int count = 0;
    for (int i = 0; i < n; ++i) {
      const auto& entity = basis.entities()[i];
      const bool end = entity.kind == reference::Entity::vertex && entity.index != f;
      if (end || (entity.kind == reference::Entity::face && entity.index == f)) on_host(f, count++) = i;
    }
  }
  Kokkos::deep_copy(t, t_host);
  Kokkos::deep_copy(weight, weight_host);
  Kokkos::deep_copy(value, value_host);
  Kokkos::deep_copy(derivative, derivative_host);
  Kokkos::deep_copy(on_face, on_host);
  return {t, weight, value, derivative, on_face};
}

}  // namespace thixis::dg
