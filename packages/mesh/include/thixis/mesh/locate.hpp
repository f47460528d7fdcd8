#pragma once
#include <array>
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// Where a point lies.
struct Place {
  LocalIndex cell = -1;    ///< the cell of this rank that holds it; -1: it is on another one, or nowhere
  double xi = 0, eta = 0;  ///< its coordinates on the reference triangle (0,0), (1,0), (0,1) of that cell
  bool inside = false;     ///< on all ranks: a cell of the mesh holds it
};

/// The places of points, to rounding: a point on the boundary of the mesh is inside. Of several cells that hold a point the one with the
/// lowest id has it, so that the answer is the same on any number of ranks. Every cell is looked at for every point. Collective.
std::vector<Place> locate(const Mesh& mesh, const std::vector<std::array<double, 2>>& points);

}  // namespace thixis::mesh
