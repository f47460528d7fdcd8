#pragma once
#include <Kokkos_Core.hpp>
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/output/fields.hpp"

namespace thixis::fv {

template <class Data>
using View = Kokkos::View<Data, Kokkos::LayoutRight>;

/// Cells of two-point fluxes as one rank sees them: intervals, rectangles of a tensor grid, or triangles of an admissible mesh. Lengths in
/// the unit of the mesh; in one dimension the section is 1.
///
/// Cells 0..owned_cells-1 are owned; the ghosts that follow are all cells that share a vertex with an owned one. Faces are those of the
/// owned cells, in the order of their ids. **Admissible**: the line through the centres of the two cells of a face is orthogonal to the
/// face, and runs from the first cell into the second one.
struct Grid {
  core::Comm comm;
  int dimension = 2;  ///< 1: intervals
  GlobalIndex global_cells = 0, global_faces = 0, global_vertices = 0;
  LocalIndex owned_cells = 0;
  LocalIndex cells = 0, faces = 0, vertices = 0;  ///< on this rank, ghosts included

  View<double* [2]> centre;          ///< x_K: midpoint of intervals and rectangles, circumcentre of triangles
  View<double* [2]> barycentre;      ///< of cells; x_K but for triangles
  View<double*> volume;              ///< |K|: length or area
  View<double*> diameter;            ///< h_K
  View<LocalIndex* [2]> face_cells;  ///< the second one is -1 on the boundary; else the one with the higher id
  View<double*> face_area;           ///< |F|; 1 in one dimension
  View<double*> face_distance;       ///< d_F: between the centres of its cells, on the boundary from the centre to the face
  View<double* [2]> face_centre;     ///< midpoint
  View<double* [2]> face_normal;     ///< unit, from the first cell to the second one, outward on the boundary
  View<LocalIndex*> face_tag;        ///< index into `tags` on the boundary, -1 inside
  /// Faces of the owned cell K: cell_faces(cell_face_begin(K)), …, in the order of rising ids.
  View<LocalIndex*> cell_face_begin, cell_faces;
  /// Corners of all cells, counter-clockwise (2 of an interval, 3 of a triangle, 4 of a rectangle): stride = corners().
  View<LocalIndex**> cell_vertices;
  View<double* [2]> vertex;  ///< coordinates of vertices; y = 0 in one dimension

  std::vector<std::string> tags;                         ///< names of the parts of the boundary, the same on all ranks
  std::vector<GlobalIndex> cell_id, face_id, vertex_id;  ///< contiguous, the same on any number of ranks
  std::vector<int> cell_owner;                           ///< ranks

  int corners() const { return cell_vertices.extent_int(1); }
};

/// The grid of block `mesh`, shared out to the ranks: generators `interval` and `tensor` (tags left, right, and bottom, top), or the
/// finest mesh of triangles. Throws InputError where two-point fluxes do not admit the triangles: a circumcentre outside of its cell's
/// side of a face or d_F not positive (as for two right triangles that share their longest side); FileError (mesh file). Collective.
Grid build(const mesh::MeshParams& params, const core::Comm& comm, const std::string& folder);

/// What fields with one value per owned cell are shown on.
output::Grid display(const Grid& grid);

}  // namespace thixis::fv
