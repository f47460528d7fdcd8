#pragma once
#include <array>
#include <vector>

#include "lift/continuous_nodes.hpp"

namespace thixis::bound {

/// The nodes of s_c: those of the space itself where it has continuous functions.
ContinuousNodes nodes_of(const method::Space& space, const std::vector<bool>& dirichlet);

/// theta_1 = mu_2/(mu_1 + mu_2) at the nodes; for Bernstein coefficients at the places of the regular lattice. Not collective.
std::vector<double> ways_of_upper(const method::Space& space, const ContinuousNodes& nodes, const std::array<scene::FieldPtr, 2>& tension);

}  // namespace thixis::bound
