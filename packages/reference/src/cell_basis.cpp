#include "thixis/reference/cell_basis.hpp"

#include <algorithm>
#include <cmath>

#include "basix.hpp"
#include "thixis/reference/bernstein_gradient.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::reference {
namespace {

/// Lagrange numbering with the nodes inside moved to the front.
std::vector<int> inside_first(const LagrangeBasis& lagrange) {
  std::vector<int> order;
  for (const bool inside : {true, false})
    for (int l = 0; l < lagrange.size(); ++l)
      if ((lagrange.entities()[l].kind == Entity::interior) == inside) order.push_back(l);
  return order;
}

std::vector<double> reordered(const std::vector<double>& points, const std::vector<int>& order) {
  std::vector<double> result;
  for (const int l : order) result.insert(result.end(), {points[2 * l], points[2 * l + 1]});
  return result;
}

/// The Bernstein polynomial of each point of the regular lattice: the one that is largest there.
Bernstein bernstein_on(const std::vector<double>& lattice, int degree) {
  constexpr double factorial[] = {1, 1, 2, 6, 24};
  Bernstein B;
  B.degree = degree;
  B.size = static_cast<int>(lattice.size()) / 2;
  for (int k = 0; k < B.size; ++k) {
    const int e1 = static_cast<int>(std::lround(degree * lattice[2 * k])), e2 = static_cast<int>(std::lround(degree * lattice[2 * k + 1]));
    const int e[3] = {degree - e1 - e2, e1, e2};
    for (int a = 0; a < 3; ++a) B.exponent[k][a] = e[a];
    B.factor[k] = factorial[degree] / (factorial[e[0]] * factorial[e[1]] * factorial[e[2]]);
  }
  return B;
}

/// V_mk = B_k(x_m)
std::vector<double> vandermonde(const Bernstein& B, const std::vector<double>& points) {
  std::vector<double> V(B.size * B.size);
  for (int m = 0; m < B.size; ++m) {
    const double lambda[3] = {1 - points[2 * m] - points[2 * m + 1], points[2 * m], points[2 * m + 1]};
    B.values(lambda, &V[m * B.size]);
  }
  return V;
}

std::vector<double> identity(int n) {
  std::vector<double> I(n * n, 0.0);
  for (int i = 0; i < n; ++i) I[i * n + i] = 1;
  return I;
}

}  // namespace

Bernstein bernstein(int degree) {
  std::vector<double> lattice;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j) lattice.insert(lattice.end(), {i / std::max(1.0, 1.0 * degree), j / std::max(1.0, 1.0 * degree)});
  return bernstein_on(lattice, degree);
}

BernsteinGradient bernstein_gradient(const Bernstein& basis) {
  BernsteinGradient gradient;
  gradient.degree = basis.degree;
  gradient.lower = bernstein(basis.degree - 1);
  for (int k = 0; k < gradient.lower.size; ++k)
    for (int a = 0; a < 3; ++a)
      for (int m = 0; m < basis.size; ++m) {
        int rest = 0;  // of e(m) - e(k) - 1_a
        for (int b = 0; b < 3; ++b) rest += std::abs(basis.exponent[m][b] - gradient.lower.exponent[k][b] - (a == b));
        if (rest == 0) gradient.raised[k][a] = m;
      }
  return gradient;
}

std::vector<double> inverse(int size, const std::vector<double>& matrix) { return basix_interface::inverse(size, matrix); }

CellBasis::CellBasis(int degree, Family family) : degree_(degree), family_(family) {
  const LagrangeBasis nodes(degree, family == Family::equispaced ? Nodes::equispaced : Nodes::gauss_lobatto);
  const LagrangeBasis regular(degree, Nodes::equispaced);
  const auto order = inside_first(nodes);
  for (const int l : order) entities_.push_back(nodes.entities()[l]);
  interior_ = nodes.size() - 3 * degree;
  points_ = reordered(nodes.points(), order);
  lattice_ = reordered(regular.points(), order);
  bernstein_ = bernstein_on(lattice_, degree);

  const int n = bernstein_.size;
  const auto V_inverse = inverse(n, vandermonde(bernstein_, points_));
  from_values_ = family == Family::bernstein ? V_inverse : identity(n);
  to_bernstein_ = family == Family::bernstein ? identity(n) : V_inverse;

  const auto rule = triangle_quadrature(2 * degree);
  const auto table = tabulate(rule.size(), rule.point.data());
  integrals_.assign(n, 0.0);
  mass_.assign(n * n, 0.0);
  for (int q = 0; q < rule.size(); ++q)
    for (int l = 0; l < n; ++l) {
      integrals_[l] += rule.weight[q] * table.value[q * n + l];
      for (int m = 0; m < n; ++m) mass_[l * n + m] += rule.weight[q] * table.value[q * n + l] * table.value[q * n + m];
    }
}

Tabulation CellBasis::tabulate(int count, const double* points) const {
  const int n = size();
  Tabulation table;
  table.points = count;
  table.functions = n;
  table.value.assign(static_cast<std::size_t>(count) * n, 0.0);
  table.gradient.assign(static_cast<std::size_t>(count) * n * 2, 0.0);
  for (int q = 0; q < count; ++q) {
    const double lambda[3] = {1 - points[2 * q] - points[2 * q + 1], points[2 * q], points[2 * q + 1]};
    double B[max_functions], dB[max_functions][3];
    bernstein_.values(lambda, B);
    bernstein_.derivatives(lambda, dB);
    for (int k = 0; k < n; ++k)
      for (int l = 0; l < n; ++l) {
        const double c = to_bernstein_[k * n + l];
        const std::size_t entry = static_cast<std::size_t>(q) * n + l;
        table.value[entry] += c * B[k];
        for (int d = 0; d < 2; ++d) table.gradient[2 * entry + d] += c * (dB[k][d + 1] - dB[k][0]);
      }
  }
  return table;
}

}  // namespace thixis::reference
