#pragma once
#include <array>
#include <vector>

/// All that is taken from Basix, in terms of the standard library.
namespace thixis::reference::basix_interface {

/// Points (flat) and weights of the default rule, exact for the given order.
std::array<std::vector<double>, 2> triangle_rule(int order);
std::array<std::vector<double>, 2> line_rule(int order);

/// The interior Gauss–Lobatto points of P_p on [0,1], in ascending order: p-1 of them.
std::vector<double> gauss_lobatto_interior(int degree);

/// Orthonormal polynomials phi_k of degree <= `degree` and their first derivatives: flat [value, d/dxi, d/deta][k][point].
std::vector<double> orthonormal(int degree, int count, const double* points);

/// Inverse of a regular matrix, both row by row.
std::vector<double> inverse(int size, const std::vector<double>& matrix);

}  // namespace thixis::reference::basix_interface
