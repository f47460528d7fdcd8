#pragma once
#include <vector>

#include "thixis/reference/bernstein.hpp"
#include "thixis/reference/modal.hpp"

namespace thixis::reference {

/// Raviart–Thomas fields given by their moments: flat (2 dim P_{q+1} × (3(q+1) + 2 dim P_{q-1})), row by row. It takes
///
///     ∫ over face i of v̂·n L_j, outward, from vertex i+1 to i+2      (i (q+1) + j),
///     ∫ v̂_d phi_k,  k < dim P_{q-1}                                  (3(q+1) + d dim P_{q-1} + k)
///
/// to the modal coefficients of the one field v̂ of RT_q that has them.
std::vector<double> from_moments(const RaviartThomas& fields);

/// (size × size) phi_l = sum_k C_kl B_k: the modal polynomials in the Bernstein basis; so C takes modal coefficients to Bernstein
/// coefficients, and its transpose moments against B_k to moments against phi_l.
std::vector<double> modal_to_bernstein(const Bernstein& basis);

}  // namespace thixis::reference
