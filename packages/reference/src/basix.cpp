#include "basix.hpp"

#include <basix/cell.h>
#include <basix/math.h>
#include <basix/polyset.h>
#include <basix/quadrature.h>

#include <algorithm>

namespace thixis::reference::basix_interface {

std::array<std::vector<double>, 2> triangle_rule(int order) {
  return basix::quadrature::make_quadrature(basix::cell::type::triangle, order);
}

std::array<std::vector<double>, 2> line_rule(int order) { return basix::quadrature::make_quadrature(basix::cell::type::interval, order); }

std::vector<double> gauss_lobatto_interior(int degree) {
  std::vector<double> points = basix::quadrature::get_gll_points(degree + 1);
  std::sort(points.begin(), points.end());
  return {points.begin() + 1, points.end() - 1};
}

std::vector<double> orthonormal(int degree, int count, const double* points) {
  const std::experimental::mdspan<const double, std::experimental::dextents<std::size_t, 2>> x(points, count, 2);
  return basix::polyset::tabulate(basix::cell::type::triangle, degree, 1, x).first;
}

std::vector<double> inverse(int size, const std::vector<double>& matrix) {
  using Matrix = std::experimental::mdspan<const double, std::experimental::dextents<std::size_t, 2>>;
  std::vector<double> identity(matrix.size(), 0.0);
  for (int i = 0; i < size; ++i) identity[i * size + i] = 1.0;
  return basix::math::solve(Matrix(matrix.data(), size, size), Matrix(identity.data(), size, size));
}

}  // namespace thixis::reference::basix_interface
