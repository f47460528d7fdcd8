#include "thixis/reference/flux_moments.hpp"

#include "thixis/reference/cell_basis.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::reference {
namespace {

std::vector<double> moments_of(const std::vector<double>& v, int q, const Modal& modal) {
  const int n = modal.size(), inside = q > 0 ? dimension(q - 1) : 0;
  std::vector<double> moments;
  for (int i = 0; i < 3; ++i) {
    const auto trace = modal.trace(i, q + 1);
    for (int j = 0; j <= q; ++j) {
      double moment = 0;
      for (int d = 0; d < 2; ++d)
        for (int k = 0; k < n; ++k) moment += face_normal[i][d] * trace[j * n + k] * v[d * n + k];
      moments.push_back(moment);
    }
  }
  for (int d = 0; d < 2; ++d)
    for (int k = 0; k < inside; ++k) moments.push_back(v[d * n + k]);
  return moments;
}

}  // namespace

std::vector<double> from_moments(const RaviartThomas& fields) {
  const int q = fields.q();
  const Modal modal(q + 1);
  std::vector<const std::vector<double>*> basis;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= q; ++j) basis.push_back(&fields.from_face(i, j));
  for (int k = 1; k < dimension(q); ++k) basis.push_back(&fields.from_density(k));
  for (int m = 0; m < fields.bubbles(); ++m) basis.push_back(&fields.bubble(m));

  const int count = static_cast<int>(basis.size()), rows = fields.flux_size();
  std::vector<double> moments(count * count);
  for (int b = 0; b < count; ++b) {
    const auto column = moments_of(*basis[b], q, modal);
    for (int i = 0; i < count; ++i) moments[i * count + b] = column[i];
  }
  const auto inverted = inverse(count, moments);
  std::vector<double> T(rows * count, 0.0);
  for (int b = 0; b < count; ++b)
    for (int r = 0; r < rows; ++r)
      for (int i = 0; i < count; ++i) T[r * count + i] += (*basis[b])[r] * inverted[b * count + i];
  return T;
}

std::vector<double> modal_to_bernstein(const Bernstein& basis) {
  const int m = basis.size;
  const auto rule = triangle_quadrature(2 * basis.degree);
  const auto phi = Modal(basis.degree).values(rule.size(), rule.point.data());
  std::vector<double> mass(m * m, 0.0), mixed(m * m, 0.0), C(m * m, 0.0), B(m);
  for (int q = 0; q < rule.size(); ++q) {
    const double lambda[3] = {1 - rule.point[2 * q] - rule.point[2 * q + 1], rule.point[2 * q], rule.point[2 * q + 1]};
    basis.values(lambda, B.data());
    for (int k = 0; k < m; ++k)
      for (int l = 0; l < m; ++l) {
        mass[k * m + l] += rule.weight[q] * B[k] * B[l];
        mixed[k * m + l] += rule.weight[q] * B[k] * phi[q * m + l];
      }
  }
  const auto inverted = inverse(m, mass);
  for (int k = 0; k < m; ++k)
    for (int i = 0; i < m; ++i)
      for (int l = 0; l < m; ++l) C[k * m + l] += inverted[k * m + i] * mixed[i * m + l];
  return C;
}

}  // namespace thixis::reference
