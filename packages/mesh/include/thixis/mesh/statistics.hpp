#pragma once
#include <cmath>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// The shape of the cells of a level, over all ranks.
struct Statistics {
  double area = 0;   ///< sum of |K|
  double h_min = 0;  ///< smallest and largest diameter h_K (longest face)
  double h_max = 0;
  double smallest_angle = 0;  ///< of all cells, in radians
  double largest_angle = 0;
};

/// Collective.
Statistics statistics(const Mesh& mesh);

/// The smallest axis-parallel box around a mesh, over all ranks.
struct Box {
  double lower[2], upper[2];
  double side(int d) const { return upper[d] - lower[d]; }
  double diagonal() const { return std::hypot(side(0), side(1)); }
};

/// Collective.
Box bounding_box(const Mesh& mesh);

}  // namespace thixis::mesh
