#pragma once
#include <array>
#include <vector>

#include "thixis/scene/field.hpp"

namespace thixis::bound {

/// What two membranes share by their stiffness, s_1 and s_2: the stiffer one gives way less.
struct Shares {
  /// s_alpha/(s_1 + s_2), theta_alpha of docs/methods/membranes.md: a gap closes at the mean with these weights. 1/2 without any stiffness.
  std::array<double, 2> of_mean = {0.5, 0.5};
  /// The part of the way that each of them goes then, theta_alpha of docs/methods/estimates.md, 4: a gap c that closes moves u_1 down by
  /// of_way[0] c and u_2 up by of_way[1] c.
  std::array<double, 2> of_way = {0.5, 0.5};
};

/// It depends on the place what stands for the stiffness:
///
///     mean diagonals of S   the equations: variables of the reduced system, and where gaps of an iterate close;
///     tensions at a place   coefficients of a function, one by one: the way that costs least where tensions vary;
///     mean tensions         the pointwise move of the feasible pair, whose energy is known for constant shares alone;
///     smallest tensions     the published bound, whose constants are theirs.
Shares shares(double upper, double lower);

/// Shares::of_way of the upper membrane at places, by the tensions there. Not collective.
std::vector<double> ways_of_upper(const std::array<scene::FieldPtr, 2>& tension, const std::vector<double>& x,
                                  const std::vector<double>& y);

}  // namespace thixis::bound
