#pragma once
#include "lattice.hpp"
#include "thixis/fv/grid.hpp"
#include "thixis/mesh/mesh.hpp"

namespace thixis::fv {

/// This rank's part of a lattice. No communication.
Grid lattice_grid(const Lattice& lattice, const core::Comm& comm);

/// This rank's part of a mesh of triangles, admissible or not. No communication.
Grid triangle_grid(const mesh::Mesh& mesh);

/// Throws an InputError on all ranks unless d_F > 0 on all faces, up to round-off; `parameter` is the one that chose the mesh. Collective.
void require_admissible(const Grid& grid, const std::string& parameter);

}  // namespace thixis::fv
