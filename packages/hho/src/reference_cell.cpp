#include "reference_cell.hpp"

#include <array>
#include <cmath>

#include "thixis/reference/flux_moments.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::hho {
namespace {

std::vector<double> at(const reference::Bernstein& B, double xi, double eta) {
  const double lambda[3] = {1 - xi - eta, xi, eta};
  std::vector<double> values(B.size);
  B.values(lambda, values.data());
  return values;
}

/// The point of face f at s, from vertex f+1 to f+2.
std::array<double, 2> on_face(int f, double s) {
  double lambda[3] = {};
  lambda[(f + 1) % 3] = 1 - s;
  lambda[(f + 2) % 3] = s;
  return {lambda[1], lambda[2]};
}

std::vector<double> product(int rows, int inner, int columns, const std::vector<double>& A, const std::vector<double>& B) {
  std::vector<double> C(rows * columns, 0.0);
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < inner; ++k)
      for (int j = 0; j < columns; ++j) C[i * columns + j] += A[i * inner + k] * B[k * columns + j];
  return C;
}

}  // namespace

ReferenceCell reference_cell(const reference::CellBasis& basis) {
  ReferenceCell cell;
  const int p = cell.degree = basis.degree(), n = cell.functions = basis.size(), width = cell.unknowns = n + 3 * p;
  cell.B = reference::bernstein(p - 1);
  const int m = cell.B.size;

  // With n |F| = -2|K| grad(lambda_f), the definition
  //   (G_K v, q)_K = (grad v_K, q)_K + sum_F (v_F - v_K, q·n)_F,  q = B_k e_d,
  // becomes  (B G_f v)_k = (dv_K/dlambda_f, B_k) + (v_K - v_F, B_k) over face f, on the reference cell and [0,1], up to what is the same
  // for all f: sum_f grad(lambda_f) = 0. dv/dlambda_f: 0, dv/dxi, dv/deta.
  std::vector<double> W[3];
  for (int f = 0; f < 3; ++f) {
    W[f].assign(m * width, 0.0);
    cell.R[f].assign(p * width, 0.0);
  }
  cell.mass.assign(m * m, 0.0);
  const auto inside = reference::triangle_quadrature(2 * p);
  const auto table = basis.tabulate(inside.size(), inside.point.data());
  for (int q = 0; q < inside.size(); ++q) {
    const auto B = at(cell.B, inside.point[2 * q], inside.point[2 * q + 1]);
    for (int k = 0; k < m; ++k) {
      const double weighted = inside.weight[q] * B[k];
      for (int l = 0; l < m; ++l) cell.mass[k * m + l] += weighted * B[l];
      for (int i = 0; i < n; ++i)
        for (int d = 0; d < 2; ++d) W[d + 1][k * width + i] += weighted * table.gradient[2 * (q * n + i) + d];
    }
  }
  const auto line = reference::line_quadrature(2 * p);
  for (int f = 0; f < 3; ++f)
    for (int q = 0; q < line.size(); ++q) {
      const auto x = on_face(f, line.point[q]);
      const auto B = at(cell.B, x[0], x[1]), L = reference::legendre(p, line.point[q]);
      const auto psi = basis.tabulate(1, x.data()).value;
      const double weight = line.weight[q];
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < m; ++k) W[f][k * width + i] += weight * B[k] * psi[i];
        for (int j = 0; j < p; ++j) cell.R[f][j * width + i] += weight * L[j] * psi[i];
      }
      for (int j = 0; j < p; ++j)
        for (int k = 0; k < m; ++k) W[f][k * width + n + f * p + j] -= weight * B[k] * L[j];
    }
  const auto mass_inverse = reference::inverse(m, cell.mass);
  for (int f = 0; f < 3; ++f) {
    cell.G[f] = product(m, m, width, mass_inverse, W[f]);
    for (int j = 0; j < p; ++j) cell.R[f][j * width + n + f * p + j] = -1;
  }
  return cell;
}

}  // namespace thixis::hho
