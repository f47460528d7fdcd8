#pragma once
#include <string>
#include <vector>

#include "thixis/bound/feasible.hpp"
#include "thixis/bound/guaranteed_bound.hpp"

namespace thixis::bound {

/// What keeps a bound from being guaranteed (docs/methods/estimates.md, 8): a clause for each function of the problem whose integrals are
/// not exact, and not bounded from above. q: of the fluxes; `proved`: TensionBounds::proved of each membrane. Says nothing of time.
/// Collective.
std::vector<std::string> doubts(const method::Space& space, const ContactProblem& problem, int q, const bool (&proved)[2],
                                const FeasiblePair& pair);

/// The same for integrals over a step of a run in time (docs/methods/parabolic_estimates.md, 8); the pairs at its ends. Collective.
std::vector<std::string> doubts_in_time(const ContactProblem& problem, const FeasiblePair& before, const FeasiblePair& after);

/// And for the error at time 0, of initial values of one membrane that are not those of u_h.
std::vector<std::string> doubts_at_start(const method::Space& space, int alpha, const scene::Field& initial);

}  // namespace thixis::bound
