#pragma once
#include <vector>

#include "thixis/reference/cell_basis.hpp"

namespace thixis::hho {

/// The operators of HHO on a cell, v = (v_K, v_F): the n coefficients of v_K in the basis of the cells, then p of each face f, in L_j from
/// vertex f+1 to f+2 (mod 3). With barycentric coordinates they are the same for all cells:
///
///     G_K v = sum_f grad(lambda_f) sum_k (G_f v)_k B_k,     Π_F v_K - v_F = sum_j (R_f v)_j L_j  on face f.
///
/// B_k: the Bernstein basis of P_{p-1}. Matrices are flat, row by row.
struct ReferenceCell {
  int degree = 0;            ///< p
  int functions = 0;         ///< n = dim P_p
  int unknowns = 0;          ///< n + 3p
  reference::Bernstein B;    ///< of degree p-1
  std::vector<double> mass;  ///< (B_k, B_l) on the reference triangle
  std::vector<double> G[3];  ///< (k, unknown)
  std::vector<double> R[3];  ///< (j, unknown)
};
ReferenceCell reference_cell(const reference::CellBasis& basis);

}  // namespace thixis::hho
