#pragma once
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// How far a force is in a step from what it is at its end.
struct ForceChange {
  double square = 0;     ///< ∫ |f(t) - f(end)|² over ]begin, end[ and the owned cells
  bool resolved = true;  ///< by Gauss' rule with three points in time, as far as 32 equal parts of the step show
};

/// By Gauss' rule with three points in time, exact where f is of degree 2 in t; and where that sees less than half of what the middles of
/// 32 parts do, as of a pulse between its points, by the same rule on each part. Collective.
ForceChange change_of_force(const method::Space& space, const scene::Field& force, double begin, double end);

}  // namespace thixis::bound
