#pragma once
#include "scene/boundary.hpp"

namespace thixis::membranes {

/// Throws where data that the deck names polynomials of some degree in every cell (scene/data/degree) are visibly none: by differences over
/// a lattice in every cell, and along every face of the boundary, at time t. Cells and faces that the interface crosses are not asked.
/// Collective.
void check_degrees(const MembraneScene& scene, const Boundary& boundary, const mesh::Mesh& mesh, double t = 0);

}  // namespace thixis::membranes
