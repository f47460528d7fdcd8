#include "lift/lift_rule.hpp"

#include "data/on_host.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::bound {

LiftRule::LiftRule(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, int order, const reference::Bernstein& of_v,
                   const std::array<scene::FieldPtr, 2>& tension, int count)
    : quadrature(method::make_quadrature(mesh, cells, order, nullptr)), table(of_v, quadrature.rule_xi) {
  for (int alpha = 0; alpha < count; ++alpha)
    if (const double* constant = tension[alpha]->constant()) mu.constant[alpha] = *constant;
    else mu.at_points[alpha] = method::tension_at_points(mesh, quadrature, *tension[alpha]);
}

double LiftRule::weigh(int alpha, LocalIndex k, const mesh::CellGeometry& K, Tabulated& L) const {
  const PointsOf points(quadrature, k);
  const auto dot = [&](int a, int b) { return K.gradient[a][0] * K.gradient[b][0] + K.gradient[a][1] * K.gradient[b][1]; };
  const double G11 = dot(1, 1), G12 = dot(1, 2), G22 = dot(2, 2);
  double energy = 0;
  for (int q = 0; q < points.count; ++q) {
    const double weight = 2 * K.area * points.weight(q) * mu(alpha, points.first + q), xi = L[1][q], eta = L[2][q];
    L[1][q] = weight * (G11 * xi + G12 * eta);
    L[2][q] = weight * (G12 * xi + G22 * eta);
    energy += L[1][q] * xi + L[2][q] * eta;
  }
  return energy;
}

LiftRule::Derivatives LiftRule::derivatives(const reference::Bernstein& B) const {
  Derivatives dB_at;
  const auto at = on_host(quadrature.rule_xi);
  for (std::size_t q = 0; q < at.extent(0); ++q) {
    const double lambda[3] = {1 - at(q, 0) - at(q, 1), at(q, 0), at(q, 1)};
    double dB[reference::max_functions][3];
    B.derivatives(lambda, dB);
    for (int d = 0; d < 2; ++d)
      for (int k = 0; k < B.size; ++k) dB_at[d].push_back(dB[k][1 + d] - dB[k][0]);
  }
  return dB_at;
}

void add_products(double factor, const LiftRule::Tabulated& f, const LiftRule::Derivatives& dB, int n, double* sum) {
  for (int d = 0; d < 2; ++d) {
    const double* row = dB[d].data();
    for (const double weight : f[1 + d]) {
      for (int k = 0; k < n; ++k) sum[k] += factor * weight * row[k];
      row += n;
    }
  }
}

}  // namespace thixis::bound
