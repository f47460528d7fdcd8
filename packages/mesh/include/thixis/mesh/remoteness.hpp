#pragma once
#include <algorithm>
#include <cmath>

namespace thixis::mesh {

/// How many times as large the coordinates of some points are as the distances between them; at(i, d): coordinate d of point i.
///
/// Coordinates are rounded by eps times their size. Values of a smooth function at these points that differ by D are then known no better
/// than numbers of the size D remoteness are.
template <class At>
double remoteness(int points, const At& at) {
  double far = 0, width = 0;
  for (int d = 0; d < 2; ++d) {
    double low = at(0, d), high = low;
    for (int i = 1; i < points; ++i) {
      low = std::min(low, at(i, d));
      high = std::max(high, at(i, d));
    }
    far = std::max({far, std::abs(low), std::abs(high)});
    width = std::max(width, high - low);
  }
  return width > 0 ? far / width : 0;
}

}  // namespace thixis::mesh
