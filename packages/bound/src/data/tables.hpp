#pragma once
#include <string>
#include <vector>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/mesh/to_view.hpp"
#include "thixis/method/cell_functions.hpp"
#include "thixis/reference/bernstein.hpp"
#include "thixis/reference/cell_basis.hpp"

/// Small matrices on the reference triangle, flat, row by row.
namespace thixis::bound {

using mesh::to_view;
using method::matrix_view;

/// (dim P_p × dim P_p): coefficients in a basis of cells -> modal ones.
std::vector<double> to_modal(const reference::CellBasis& basis, const reference::Modal& modal);
/// (n × n): moments against the functions of a basis -> modal coefficients.
std::vector<double> from_moments(const reference::CellBasis& basis, const reference::Modal& modal);

/// The lattice points of a Bernstein basis, flat [n][3] barycentric, and (n × n) values there -> coefficients.
std::vector<double> bernstein_lattice(const reference::Bernstein& B);
std::vector<double> from_lattice(const reference::Bernstein& B);
/// (m × n): Bernstein coefficients -> the first m modal ones.
std::vector<double> bernstein_to_modal(const reference::Bernstein& B, const reference::Modal& modal, int m);

/// (i, m, k): coefficient m of lambda_i phi_k, m < dim P_q, k < dim P_{q+1}.
Kokkos::View<const double***, Kokkos::LayoutRight> times_hats(int q);

}  // namespace thixis::bound
