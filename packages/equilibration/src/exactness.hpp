#pragma once
#include <string>
#include <vector>

#include "thixis/equilibration/feasible.hpp"
#include "thixis/equilibration/guaranteed_bound.hpp"

namespace thixis::equilibration {

/// What keeps a bound from being guaranteed (docs/methods/estimates.md, 8): a clause for each function of the problem whose integrals are
/// not exact, and not bounded from above. q: of the fluxes; `proved`: TensionBounds::proved of each membrane. Says nothing of time.
/// Collective.
std::vector<std::string> doubts(const method::PolynomialSpace& space, const ContactProblem& problem, int q, const bool (&proved)[2],
                                const FeasiblePair& pair);

}  // namespace thixis::equilibration
