#pragma once
#include "thixis/method/space.hpp"

/// What is measured of functions, over the whole mesh.
namespace thixis::method {

/// ∫ (u - u_h)². Collective.
double l2_error(const Space& space, const Coefficients& uh, const scene::FieldPtr& u, double t);
/// max(max(obstacle - u_h, 0)) over all points of all cells, to a few per cent (a lattice of 8p points a side). `obstacle` null: zero.
/// Collective.
double penetration(const Space& space, const Coefficients& uh, const scene::Field* obstacle, double t);

}  // namespace thixis::method
