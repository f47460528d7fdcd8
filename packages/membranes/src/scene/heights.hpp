#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scene/boundary.hpp"

namespace thixis::membranes {

/// Between which heights each membrane is held.
struct Heights {
  std::array<double, 2> low, high;

  Heights() {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
  }
  bool any() const { return low[0] <= high[0] || low[1] <= high[1]; }

  /// The height closest to zero between those of one membrane: that of a membrane at rest. 0 where nothing holds it.
  double rest(int alpha) const { return low[alpha] <= high[alpha] ? std::clamp(0.0, low[alpha], high[alpha]) : 0; }
  /// … and between those of all: what heights are counted from.
  double origin() const { return any() ? std::clamp(0.0, std::min(low[0], low[1]), std::max(high[0], high[1])) : 0; }
  /// The largest one between which a membrane is held, in absolute value. 0 where nothing holds it.
  double size(int alpha) const { return low[alpha] <= high[alpha] ? std::max(std::abs(low[alpha]), std::abs(high[alpha])) : 0; }
};

/// At the vertices of the held boundary at time t. Where nothing is held, those of the initial values. Collective.
Heights heights_of(const MembraneScene& scene, const mesh::Mesh& mesh, double t);

/// The same scene with all heights counted from `origin`: boundary data, obstacle, exact solution, initial values. Only differences of
/// heights matter, and those of heights around 1e9 drown in round-off where one computes with the heights themselves.
MembraneScene counted_from(double origin, MembraneScene scene);

}  // namespace thixis::membranes
