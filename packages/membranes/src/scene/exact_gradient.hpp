#pragma once
#include <array>

#include "thixis/membranes/scene.hpp"
#include "thixis/mesh/mesh.hpp"

namespace thixis::membranes {

/// Gradient of the exact solution of membrane alpha: the scene's own, or sixth-order differences of u_alpha, whose step is 1e-6 of the
/// diagonal of the box around the mesh, so that it means the same in every unit of length: round-off 2e-10 |u|/diagonal, and where the
/// interface is within three steps of a point 1e-6 diagonals times the jump of second derivatives. Collective.
std::array<scene::FieldPtr, 2> exact_gradient(const ExactMembranes& exact, int alpha, const mesh::Mesh& mesh);

}  // namespace thixis::membranes
