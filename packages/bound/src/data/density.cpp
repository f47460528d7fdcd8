#include "data/density.hpp"

#include "data/tables.hpp"
#include "thixis/method/cell_functions.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::bound {

Matrix density_monomials() {
  constexpr int q = max_density_degree, n = max_density;
  std::vector<double> lattice;
  for (int i = 0; i <= q; ++i)
    for (int j = 0; i + j <= q; ++j) lattice.insert(lattice.end(), {static_cast<double>(i) / q, static_cast<double>(j) / q});
  std::vector<double> monomial(n * n), unit(n, 0.0);
  DensityValues values;
  values.degree = q;
  for (int k = 0; k < n; ++k) {
    unit.assign(n, 0.0);
    unit[k] = 1;
    for (int m = 0; m < n; ++m) monomial[m * n + k] = values.value(unit.data(), lattice[2 * m], lattice[2 * m + 1]);
  }
  const auto inverse = reference::inverse(n, monomial);
  const auto phi = reference::Modal(q).values(n, lattice.data());
  std::vector<double> M(n * n, 0.0);
  for (int i = 0; i < n; ++i)
    for (int m = 0; m < n; ++m)
      for (int k = 0; k < n; ++k) M[i * n + k] += inverse[i * n + m] * phi[m * n + k];
  return method::matrix_view("thixis::bound::density_monomials", n, n, M);
}

Matrix bernstein_to_modal(const reference::CellBasis& basis) {
  const reference::Bernstein& B = basis.bernstein();
  return method::matrix_view("thixis::bound::bernstein_to_modal", B.size, B.size,
                             bernstein_to_modal(B, reference::Modal(B.degree), B.size));
}

}  // namespace thixis::bound
