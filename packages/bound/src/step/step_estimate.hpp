#pragma once
#include <array>

#include "estimate/flux_terms.hpp"
#include "step/bound_so_far.hpp"
#include "step/step_terms.hpp"

namespace thixis::bound {

/// What the bound of a step is made of, over all ranks.
struct StepFigures {
  int count = 2;  ///< membranes
  double tau = 0;
  double friedrichs = 0;                                                     ///< 0: none
  double least[2] = {1, 1};                                                  ///< tension of all
  std::array<double, 2> apart;                                               ///< FeasiblePair::apart
  double force[2] = {0, 0};                                                  ///< ∫ |f(t) - f(t_n)|²
  double left_disc[2] = {0, 0}, left_lin[2] = {0, 0}, left_alg[2] = {0, 0};  ///< norms of means that no flux takes away
  Sums<OfFlux> flux;
  Sums<OfStep> sum;
};

/// eta_n and its parts (docs/methods/parabolic_estimates.md), but for promise, worst cells and evidence.
StepEstimate estimate(const StepFigures& of);

}  // namespace thixis::bound
