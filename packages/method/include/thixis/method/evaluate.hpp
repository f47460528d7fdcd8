#pragma once
#include "thixis/method/quadrature.hpp"

namespace thixis::method {

/// values(q) = field(x(q), y(q), t) for the first `points` of x and y. Fields are evaluated on the host: what they see are mirrors. Throws
/// InputError where the field is not finite, on this rank only.
void evaluate(const scene::Field& field, double t, int points, const View<const double*>& x, const View<const double*>& y,
              const View<double*>& values);

}  // namespace thixis::method
