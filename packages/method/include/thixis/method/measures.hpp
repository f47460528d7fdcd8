#pragma once
#include <vector>

#include "thixis/mesh/locate.hpp"
#include "thixis/method/space.hpp"

/// What is measured of functions: over the whole mesh, and at places.
namespace thixis::method {

/// ∫ (u - u_h)². Collective.
double l2_error(const Space& space, const Coefficients& uh, const scene::FieldPtr& u, double t);
/// max(max(obstacle - u_h, 0)) over all points of all cells, to a few per cent (a lattice of 8p points a side). `obstacle` null: zero.
/// Collective.
double penetration(const Space& space, const Coefficients& uh, const scene::Field* obstacle, double t);
/// u_h at places of the mesh of the space (mesh::locate), on all ranks. Collective.
std::vector<double> values_at(const Space& space, const std::vector<mesh::Place>& places, const Coefficients& u);

}  // namespace thixis::method
