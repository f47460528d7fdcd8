#include "thixis/reference/lagrange.hpp"

#include <cmath>
#include <string>

#include "basix.hpp"
#include "thixis/core/error.hpp"

namespace thixis::reference {
namespace {

constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
constexpr double interior_p4 = 0.2169;  // all basis functions have non-negative means for 0.19 <= c <= 0.219

int dimension(int degree) { return (degree + 1) * (degree + 2) / 2; }

std::vector<double> face_nodes(int degree, Nodes nodes) {
  if (nodes == Nodes::gauss_lobatto && degree > 1) return basix_interface::gauss_lobatto_interior(degree);
  std::vector<double> s;
  for (int k = 1; k < degree; ++k) s.push_back(static_cast<double>(k) / degree);
  return s;
}

std::vector<double> interior_nodes(int degree, Nodes nodes) {
  if (degree < 3) return {};
  if (degree == 3) return {1.0 / 3, 1.0 / 3};
  const double c = nodes == Nodes::gauss_lobatto ? interior_p4 : 0.25;
  return {c, c, 1 - 2 * c, c, c, 1 - 2 * c};
}

}  // namespace

LagrangeBasis::LagrangeBasis(int degree, Nodes nodes) : degree_(degree) {
  if (degree < 1 || degree > 4)
    throw core::InputError("The degree of a Lagrange basis must be between 1 and 4, not " + std::to_string(degree) + ".");
  const auto add = [this](double xi, double eta, Entity kind, int index) {
    points_.insert(points_.end(), {xi, eta});
    entities_.push_back({kind, index});
  };
  for (int v = 0; v < 3; ++v) add(corner[v][0], corner[v][1], Entity::vertex, v);
  for (int i = 0; i < 3; ++i) {
    const double* a = corner[(i + 1) % 3];
    const double* b = corner[(i + 2) % 3];
    for (const double s : face_nodes(degree, nodes)) add(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), Entity::face, i);
  }
  const std::vector<double> inside = interior_nodes(degree, nodes);
  for (std::size_t k = 0; k < inside.size(); k += 2) add(inside[k], inside[k + 1], Entity::interior, 0);

  // psi_l = sum_k c_kl phi_k with V_mk = phi_k(node m): V c = Id.
  const int n = dimension(degree);
  const std::vector<double> phi = basix_interface::orthonormal(degree, n, points_.data());
  std::vector<double> vandermonde(n * n);
  for (int k = 0; k < n; ++k)
    for (int m = 0; m < n; ++m) vandermonde[m * n + k] = phi[k * n + m];
  coefficients_ = basix_interface::inverse(n, vandermonde);

  // phi_0 = sqrt(2) is the only one with a mean: (psi_l, 1) = c_0l (phi_0, 1) = c_0l sqrt(2)/2.
  integrals_.assign(coefficients_.begin(), coefficients_.begin() + n);
  for (double& integral : integrals_) integral *= std::sqrt(0.5);
}

Tabulation LagrangeBasis::tabulate(int count, const double* points) const {
  const int n = size();
  Tabulation table;
  table.points = count;
  table.functions = n;
  table.value.assign(static_cast<std::size_t>(count) * n, 0.0);
  table.gradient.assign(static_cast<std::size_t>(count) * n * 2, 0.0);
  const std::vector<double> phi = basix_interface::orthonormal(degree_, count, points);
  const auto orthonormal = [&](int derivative, int k, int q) { return phi[(static_cast<std::size_t>(derivative) * n + k) * count + q]; };
  for (int q = 0; q < count; ++q)
    for (int k = 0; k < n; ++k)
      for (int l = 0; l < n; ++l) {
        const std::size_t entry = static_cast<std::size_t>(q) * n + l;
        const double c = coefficients_[k * n + l];
        table.value[entry] += c * orthonormal(0, k, q);
        table.gradient[2 * entry] += c * orthonormal(1, k, q);
        table.gradient[2 * entry + 1] += c * orthonormal(2, k, q);
      }
  return table;
}

}  // namespace thixis::reference
