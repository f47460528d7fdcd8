#pragma once
#include "thixis/bound/cell_fields.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::bound {

constexpr int max_density_degree = 6;
constexpr int max_density = reference::dimension(max_density_degree);

/// Values of densities in kernels: sum_k g_k phi_k = sum_ij a_ij xi^i eta^j. Monomials by degree: of degree d, xi^d first.
struct DensityValues {
  Matrix to_monomials;  ///< (max_density × max_density); the first dim P_q rows and columns for degree q
  int degree = 0;

  KOKKOS_FUNCTION void monomials(const double* modal, double* a) const {
    const int n = reference::dimension(degree);
    for (int i = 0; i < n; ++i) {
      a[i] = 0;
      for (int k = 0; k < n; ++k) a[i] += to_monomials(i, k) * modal[k];
    }
  }
  KOKKOS_FUNCTION double value(const double* a, double xi, double eta) const {
    double power[max_density_degree + 1] = {1}, sum = a[0];  // xi^(d-i) eta^i of degree d from those of degree d - 1
    for (int d = 1, at = 1; d <= degree; ++d) {
      power[d] = power[d - 1] * eta;
      for (int i = 0; i < d; ++i) power[i] *= xi;
      for (int i = 0; i <= d; ++i) sum += a[at++] * power[i];
    }
    return sum;
  }
};

/// For degrees up to max_density_degree.
Matrix density_monomials();
/// (dim P_p × n): modal coefficients of the Bernstein polynomials of a basis.
Matrix bernstein_to_modal(const reference::CellBasis& basis);

}  // namespace thixis::bound
