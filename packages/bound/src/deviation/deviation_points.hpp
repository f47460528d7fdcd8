#pragma once
#include <vector>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::bound {

/// The part of a quadrature at some positions.
method::CellQuadrature subset(const method::CellQuadrature& all, const std::vector<LocalIndex>& positions);

/// The same rule on each of sides² equal parts of every cell: integrands jump where the gap changes its sign.
method::CellQuadrature composite(method::CellQuadrature quadrature, int sides);

/// Points of the reference triangle on its faces, those of one after those of the other.
constexpr int points_of_face = 16;
View<double* [2]> face_points();

/// Marks the held faces of a cell on which D, given at face_points(), is more than round-off.
void mark_held(const mesh::HostMesh& host, const std::vector<bool>& dirichlet, LocalIndex K, const double* D, double noise,
               const View<bool* [3]>& on_held, LocalIndex place);

/// A place for each owned cell, none yet: -1.
View<LocalIndex*> nowhere(const mesh::Mesh& mesh);

}  // namespace thixis::bound
