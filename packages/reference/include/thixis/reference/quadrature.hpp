#pragma once
#include <vector>

namespace thixis::reference {

/// Highest order of exactness offered by the rules of this file.
constexpr int max_quadrature_order = 30;

/// A quadrature rule, integral of f ≈ sum_q weight[q] f(point q), with positive weights and points inside the reference cell.
struct Quadrature {
  int order = 0;              ///< exact for all polynomials of this total degree
  std::vector<double> point;  ///< flat [size][dimension]
  std::vector<double> weight;
  int size() const { return static_cast<int>(weight.size()); }
};

/// Xiao–Gimbutas rule on the triangle {(0,0),(1,0),(0,1)}; the weights sum to 1/2. Throws InputError unless 0 <= order <= 30.
Quadrature triangle_quadrature(int order);

/// Gauss–Legendre rule on the line [0,1]; the weights sum to 1. Throws InputError unless 0 <= order <= 30.
Quadrature line_quadrature(int order);

}  // namespace thixis::reference
