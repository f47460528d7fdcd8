#include "thixis/reference/modal.hpp"

#include <cmath>

#include "thixis/core/error.hpp"
#include "thixis/reference/cell_basis.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::reference {
namespace {

constexpr int highest_degree = 6;
constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};

/// A number with its derivatives in xi and eta.
struct Dual {
  double value = 0, d[2] = {0, 0};
};
Dual operator+(Dual a, Dual b) { return {a.value + b.value, {a.d[0] + b.d[0], a.d[1] + b.d[1]}}; }
Dual operator*(double s, Dual a) { return {s * a.value, {s * a.d[0], s * a.d[1]}}; }
Dual operator*(Dual a, Dual b) { return {a.value * b.value, {a.d[0] * b.value + a.value * b.d[0], a.d[1] * b.value + a.value * b.d[1]}}; }

/// The polynomials of Koornwinder and Dubiner, not normalized, by degree m + n,
///
///     (1-eta)^m P_m((2 xi + eta - 1)/(1 - eta)) · P_n^{(2m+1, 0)}(2 eta - 1).
std::vector<Dual> koornwinder(int degree, double xi, double eta) {
  const Dual one{1, {0, 0}}, x{2 * xi + eta - 1, {2, 1}}, z{2 * eta - 1, {0, 2}}, w{1 - eta, {0, -1}};
  std::vector<Dual> phi(dimension(degree));
  Dual before, legendre = one;
  for (int m = 0; m <= degree; ++m) {
    if (m > 0) {
      const Dual next = (1.0 / m) * ((2.0 * m - 1) * (x * legendre) + (-(m - 1.0)) * (w * w * before));
      before = legendre;
      legendre = next;
    }
    const double a = 2 * m + 1;
    Dual jacobi_before, jacobi = one;
    for (int n = 0; m + n <= degree; ++n) {
      if (n > 0) {
        const double s = 2 * n + a, b1 = (s - 1) * s * (s - 2), b2 = (s - 1) * a * a, b3 = 2 * (n + a - 1) * (n - 1) * s,
                     b4 = 2 * n * (n + a) * (s - 2);
        const Dual next = n == 1 ? 0.5 * ((a + 2) * z + a * one) : (1 / b4) * (b1 * (z * jacobi) + b2 * jacobi + (-b3) * jacobi_before);
        jacobi_before = jacobi;
        jacobi = next;
      }
      phi[dimension(m + n - 1) + n] = legendre * jacobi;
    }
  }
  return phi;
}

/// Factors that make them orthonormal.
const std::vector<double>& normalization() {
  static const std::vector<double> factor = [] {
    std::vector<double> square(dimension(highest_degree), 0.0);
    const auto rule = triangle_quadrature(2 * highest_degree);
    for (int q = 0; q < rule.size(); ++q) {
      const auto phi = koornwinder(highest_degree, rule.point[2 * q], rule.point[2 * q + 1]);
      for (std::size_t k = 0; k < phi.size(); ++k) square[k] += rule.weight[q] * phi[k].value * phi[k].value;
    }
    for (double& s : square) s = 1 / std::sqrt(s);
    return square;
  }();
  return factor;
}

std::vector<Dual> orthonormal(int degree, double xi, double eta) {
  auto phi = koornwinder(degree, xi, eta);
  for (std::size_t k = 0; k < phi.size(); ++k) phi[k] = normalization()[k] * phi[k];
  return phi;
}

std::array<double, 2> on_face(int f, double s) {
  std::array<double, 2> point{};
  for (int d = 0; d < 2; ++d) point[d] = (1 - s) * corner[(f + 1) % 3][d] + s * corner[(f + 2) % 3][d];
  return point;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}
void add(double factor, const std::vector<double>& a, std::vector<double>& sum) {
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] += factor * a[i];
}

/// Adds to an orthonormal family what is new in v; nothing if it depends on it.
void extend(std::vector<double> v, std::vector<std::vector<double>>& family) {
  const double before = std::sqrt(dot(v, v));
  for (int pass = 0; pass < 2; ++pass)
    for (const auto& e : family) add(-dot(e, v), e, v);
  const double norm = std::sqrt(dot(v, v));
  if (norm < 1e-10 * before || before == 0) return;
  for (double& x : v) x /= norm;
  family.push_back(std::move(v));
}

/// An orthonormal basis of RT_q = P_q² + x P_q.
std::vector<std::vector<double>> raviart_thomas_basis(int q, const Modal& modal) {
  const int n = modal.size();
  std::vector<std::vector<double>> family;
  for (int component = 0; component < 2; ++component)
    for (int k = 0; k < dimension(q); ++k) {
      std::vector<double> v(2 * n, 0.0);
      v[component * n + k] = 1;
      family.push_back(std::move(v));
    }
  for (int k = dimension(q - 1); k < dimension(q); ++k) {
    std::vector<double> v(2 * n, 0.0);
    for (int component = 0; component < 2; ++component)
      for (int l = 0; l < n; ++l) v[component * n + l] = modal.times_barycentric(component + 1)[l * n + k];
    extend(std::move(v), family);
  }
  return family;
}

/// Data of a flux: its normal moments on the faces, then the coefficients 1, 2, … of its divergence.
std::vector<double> data_of(const std::vector<double>& v, int q, const Modal& modal) {
  const int n = modal.size();
  std::vector<double> data;
  for (int i = 0; i < 3; ++i) {
    const auto trace = modal.trace(i, q + 1);
    for (int j = 0; j <= q; ++j) {
      double moment = 0;
      for (int component = 0; component < 2; ++component)
        for (int k = 0; k < n; ++k) moment += face_normal[i][component] * trace[j * n + k] * v[component * n + k];
      data.push_back(moment);
    }
  }
  for (int l = 1; l < dimension(q); ++l) {
    double coefficient = 0;
    for (int component = 0; component < 2; ++component)
      for (int k = 0; k < n; ++k) coefficient += modal.derivative(component)[l * n + k] * v[component * n + k];
    data.push_back(coefficient);
  }
  return data;
}

}  // namespace

Modal::Modal(int degree) : degree_(degree) {
  if (degree < 0 || degree > highest_degree)
    throw core::Error(core::ExitCode::internal, "Modal polynomials are tabulated for degrees 0 to 6.");
  const int n = size();
  for (auto& matrix : derivative_) matrix.assign(n * n, 0.0);
  for (auto& matrix : barycentric_) matrix.assign(n * n, 0.0);
  const auto rule = triangle_quadrature(2 * degree + 1);
  for (int q = 0; q < rule.size(); ++q) {
    const double xi = rule.point[2 * q], eta = rule.point[2 * q + 1], lambda[3] = {1 - xi - eta, xi, eta};
    const auto phi = orthonormal(degree, xi, eta);
    for (int l = 0; l < n; ++l)
      for (int k = 0; k < n; ++k) {
        const double tested = rule.weight[q] * phi[l].value;
        for (int d = 0; d < 2; ++d) derivative_[d][l * n + k] += tested * phi[k].d[d];
        for (int a = 0; a < 3; ++a) barycentric_[a][l * n + k] += tested * lambda[a] * phi[k].value;
      }
  }
}

std::vector<double> Modal::values(int count, const double* points) const {
  std::vector<double> table;
  table.reserve(count * size());
  for (int q = 0; q < count; ++q)
    for (const Dual& phi : orthonormal(degree_, points[2 * q], points[2 * q + 1])) table.push_back(phi.value);
  return table;
}

std::vector<double> Modal::restriction(const Part& part) const {
  const int n = size();
  std::vector<double> R(n * n, 0.0);
  const auto rule = triangle_quadrature(2 * degree_);
  for (int q = 0; q < rule.size(); ++q) {
    const double xi = rule.point[2 * q], eta = rule.point[2 * q + 1], lambda[3] = {1 - xi - eta, xi, eta};
    double at[2] = {0, 0};
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d) at[d] += lambda[i] * part[i][d + 1];
    const auto phi = orthonormal(degree_, xi, eta), of_whole = orthonormal(degree_, at[0], at[1]);
    for (int l = 0; l < n; ++l)
      for (int k = 0; k < n; ++k) R[l * n + k] += rule.weight[q] * phi[l].value * of_whole[k].value;
  }
  return R;
}

std::vector<double> Modal::trace(int face, int count) const {
  const int n = size();
  std::vector<double> T(count * n, 0.0);
  const auto rule = line_quadrature(degree_ + count);
  for (int q = 0; q < rule.size(); ++q) {
    const auto x = on_face(face, rule.point[q]);
    const auto phi = orthonormal(degree_, x[0], x[1]);
    const auto L = legendre(count, rule.point[q]);
    for (int j = 0; j < count; ++j)
      for (int k = 0; k < n; ++k) T[j * n + k] += rule.weight[q] * L[j] * phi[k].value;
  }
  return T;
}

std::vector<double> legendre(int count, double s) {
  const double x = 2 * s - 1;
  std::vector<double> P(count), L(count);
  for (int j = 0; j < count; ++j) {
    P[j] = j == 0 ? 1 : j == 1 ? x : ((2 * j - 1) * x * P[j - 1] - (j - 1) * P[j - 2]) / j;
    L[j] = std::sqrt(2 * j + 1.0) * P[j];
  }
  return L;
}

RaviartThomas::RaviartThomas(int q) : q_(q) {
  const Modal modal(q + 1);
  const auto basis = raviart_thomas_basis(q, modal);
  std::vector<std::vector<double>> data;
  for (const auto& v : basis) data.push_back(data_of(v, q, modal));
  const int size = static_cast<int>(data[0].size());
  std::vector<double> gram(size * size, 0.0);  // C C^T
  for (const auto& column : data)
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) gram[i * size + j] += column[i] * column[j];
  const auto gram_inverse = inverse(size, gram);

  // v = C^T (C C^T)^{-1} e_i: least norm with the data e_i
  std::vector<std::vector<double>> solved, family;
  for (int i = 0; i < size; ++i) {
    std::vector<double> v(flux_size(), 0.0);
    for (std::size_t m = 0; m < basis.size(); ++m) {
      double x = 0;
      for (int j = 0; j < size; ++j) x += data[m][j] * gram_inverse[j * size + i];
      add(x, basis[m], v);
    }
    extend(v, family);
    solved.push_back(std::move(v));
  }
  face_.assign(solved.begin(), solved.begin() + 3 * (q + 1));
  density_.push_back(std::vector<double>(flux_size(), 0.0));
  density_.insert(density_.end(), solved.begin() + 3 * (q + 1), solved.end());
  const std::size_t constrained = family.size();
  for (const auto& v : basis) extend(v, family);
  bubble_.assign(family.begin() + static_cast<std::ptrdiff_t>(constrained), family.end());
}

}  // namespace thixis::reference
