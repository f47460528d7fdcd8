#pragma once
/// What the feasible pair costs where the multiplier presses on gaps that contact leaves open, and where it does not.
#include "feasible_setting.hpp"

namespace thixis::bound {

using Gaps = FeasiblePair::Gaps;

/// |||s - u_h|||² and 2 (lambda, s_1 - s_2) over all cells.
struct Price {
  double energy, contact;
  bool at_points;
  double sum() const { return energy + contact; }
};
inline Price price(const FeasiblePair& s, const Coefficients (&u)[2], const CellTable& lambda, int degree, Gaps gaps,
                   const core::Comm& comm) {
  FeasiblePair::Parts parts;
  s.evaluate(u, lambda, degree, parts, 0, gaps);
  return {sum_of(comm, parts.whole, 2), 2 * sum_of(comm, parts.contact), comm.any(parts.at_points)};
}

}  // namespace thixis::bound
