#pragma once
#include "estimate/sums.hpp"
#include "thixis/bound/feasible.hpp"
#include "thixis/bound/guaranteed_bound.hpp"

namespace thixis::bound {

/// What the feasible pair adds to the square of the bound of a stationary problem.
struct OfPair {
  enum { whole, rest, at_nodes, contact, contact_at_points, count };
};

/// Squares of FeasiblePair::Parts, and the contact terms; makes the parts of each cell from the squares of its fluxes.
struct PairTerms {
  View<const double*> whole, rest, at_nodes, contact, contact_lin;
  GuaranteedBound::CellParts cells;  ///< in: squares of the flux terms; out: the roots of all

  KOKKOS_FUNCTION void operator()(int K, Sums<OfPair>& sum) const;
};

}  // namespace thixis::bound
