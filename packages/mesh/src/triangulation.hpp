#pragma once
#include <array>
#include <string>
#include <vector>

#include "thixis/core/types.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// A mesh as a generator or a file gives it, the same on all ranks.
struct Triangulation {
  struct Segment {
    LocalIndex first, second;  ///< vertices
    int tag;                   ///< index into `tags`
  };
  std::vector<std::array<double, 2>> points;     ///< in the parameter domain; each is the vertex of some cell
  std::vector<std::array<LocalIndex, 3>> cells;  ///< vertices counter-clockwise
  std::vector<Segment> boundary;  ///< tagged faces, some perhaps with several tags; those inside the domain are ignored, faces of the
                                  ///< boundary missing here get "boundary"
  std::vector<std::string> tags;
  Refinement refinement = Refinement::red;
  Chart chart = Chart::identity;
  std::string name;  ///< how messages call it
};

/// The generators expect parameters without mistake().
///
/// Squares of one size on the rectangle lower..upper, `cells per side` along its shorter side, tags left, right, bottom, top.
/// criss_cross: each cut by both diagonals, vertex 0 the centre, bisection; rectangle: cut from lower left to upper right, red refinement.
Triangulation rectangle_mesh(const MeshParams& params);

/// The unit disk with N rings: on ring k = 0..N the points k/N exp(2 pi i j / (6k)), 6 N^2 cells, tag "circle". The parameter domain is
/// the hexagon with its equilateral lattice.
Triangulation disk_mesh(const MeshParams& params);

/// Triangles of a Gmsh file (formats 2.2 and 4.1), named parts of its boundary: the physical groups of dimension 1. Orients the cells,
/// drops nodes without cell. Nothing in the file is ever executed. Not collective. Throws FileError, InputError.
Triangulation read_gmsh(const std::string& path);

/// The same of the bytes of a file, which messages call `name`.
Triangulation gmsh_triangulation(std::string bytes, const std::string& name);

/// Makes the coarsest level of it, whole on every rank, ids = local numbers, everything owned by rank 0. Throws InputError unless the cells
/// are counter-clockwise, meet in whole faces, two at most, and the boundary does not touch itself.
Mesh make_mesh(const Triangulation& triangulation, const core::Comm& comm);

/// Throws InputError if the boundary touches itself: two vertices at one place, a vertex inside a face (hanging node), or a vertex with
/// more than two faces of the boundary.
void require_simple_boundary(const Mesh& mesh, const std::string& name);

}  // namespace thixis::mesh
