#pragma once
#include <memory>

#include "estimate/bound_parts.hpp"

namespace thixis::bound {

/// What a step begins with. Made from the iterate there alone, so that a run that goes on from a checkpoint makes the same.
struct StepBegin {
  double begin = 0, end = 0;
  struct Membrane {
    method::Coefficients u;
    CellTable w;      ///< (patch cell, 2 dim P_q): mu grad u_h
    CellTable moved;  ///< u_h - s_N, functions of degree p in modal coefficients; of length 0: zero
    CellTable sigma;  ///< conforming spaces: the flux of -moved/tau; of length 0: zero
    double left = 0;  ///< the norm of its means that no flux takes away
  } membrane[2];
  std::shared_ptr<const FeasiblePair> feasible;
  FeasiblePair::Continuous s_c;
  FeasiblePair::Way way;
  FeasiblePair::Parts pair;

  double tau() const { return end - begin; }
  std::size_t bytes() const;
};

/// How the data change in a step.
struct DataChange {
  View<double* [2]> lift;  ///< |L_alpha(end) - L_alpha(begin)|_K; of length 0: zero
  FeasiblePair::Bulge bulge;
  double force[2] = {0, 0};  ///< ∫ |f(t) - f(end)|² over the step and the domain
  bool resolved = true;      ///< ForceChange
};

/// Overwrites `of` but for its feasible pair; `remaining` is scratch, (owned cell, dim P_p). Collective.
void begin_step(const BoundParts& parts, const method::Coefficients (&u)[2], const CellTable& remaining, StepBegin& of);

}  // namespace thixis::bound
