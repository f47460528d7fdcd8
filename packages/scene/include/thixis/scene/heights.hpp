#pragma once
#include "thixis/scene/membranes.hpp"

namespace thixis::scene {

/// f + by. Null for null.
FieldPtr shifted(const FieldPtr& f, double by);

/// The same scene with all heights counted from `origin`: boundary data, obstacle, exact solution, initial values. Only differences of
/// heights matter, and those of heights around 1e9 drown in round-off where one computes with the heights themselves.
MembraneScene counted_from(double origin, MembraneScene scene);

}  // namespace thixis::scene
