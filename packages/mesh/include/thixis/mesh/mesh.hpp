#pragma once
#include <Kokkos_Core.hpp>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::mesh {

template <class Data>
using View = Kokkos::View<Data, Kokkos::LayoutRight>;

/// How the cells of the next level are cut where all are: every uniform refinement puts one vertex on each face and makes four cells of
/// each.
enum class Refinement {
  red,       ///< three corner triangles and the middle one, all similar to the parent
  bisection  ///< two newest-vertex bisections: vertex 0 is the newest vertex, its opposite face the refinement edge
};

/// Maps the straight parameter domain, in which faces are halved, to the physical one.
enum class Chart {
  identity,
  disk  ///< hexagon to disk: hexagonal norm -> radius, fraction of a side -> fraction of 60 degrees
};

/// How a child lies in its parent: an index into child_shapes() (thixis/mesh/ancestry.hpp); 0: the child is the whole parent.
using ChildShape = std::uint8_t;

/// One level of a triangle mesh as one rank sees it: its own cells, then the ghost cells.
///
/// Levels coarser than the one that is partitioned are held whole by every rank. On that level the ghosts are all cells that share a vertex
/// with an owned cell, and more where there is a coarser level: the children of all cells that share a vertex with the parent of an
/// owned cell. Finer levels hold the descendants of owned and ghost cells. Hence on every level every vertex of an owned cell and every
/// owned vertex has all its cells on this rank, and the cells around an owned vertex have all their children there. Cells
/// 0..owned_cells-1 are owned; vertices and faces have an owner that every rank knows without communication: one of those of the cells
/// around. `*_id` are global identities that do not depend on the number of ranks: contiguous 0..global_*-1, vertex ids of a level go on in
/// the next one.
///
/// Adaptive levels have their own partition each: the ghosts are the cells that share a vertex with an owned one, and the parent of a cell
/// may be on another rank.
///
/// Local numbering of a cell: vertices counter-clockwise, face i opposite vertex i. A face goes from its vertex of lower id to the
/// one of higher id; its normal is the tangent turned by -90 degrees.
struct Mesh {
  core::Comm comm;

  GlobalIndex global_cells = 0, global_vertices = 0, global_faces = 0;
  LocalIndex owned_cells = 0;                     ///< owned cells come first
  LocalIndex cells = 0, vertices = 0, faces = 0;  ///< on this rank, ghosts included

  View<double* [2]> coordinates;  ///< of vertices, physical
  View<double* [2]> parameter;    ///< of vertices, in the parameter domain (the same View for the identity chart)
  View<LocalIndex* [3]> cell_vertices;
  View<LocalIndex* [3]> cell_faces;
  View<LocalIndex* [2]> face_vertices;  ///< lower id first
  View<LocalIndex* [2]> face_cells;  ///< first: the cell whose outward normal is the face normal, if on this rank; -1 where there is none
  View<LocalIndex*> face_tag;        ///< -1 inside, else index into `tags`
  View<LocalIndex*>
      ghost_patch_cells;  ///< ghost cells that share a vertex with an owned cell: with the owned ones, all cells of owned rows

  std::vector<std::string> tags;  ///< names of the parts of the boundary, the same on all ranks

  std::vector<GlobalIndex> cell_id, vertex_id, face_id;
  std::vector<int> cell_owner, vertex_owner, face_owner;  ///< ranks

  /// Relation to the next coarser level (empty on the coarsest).
  std::vector<LocalIndex> cell_parent;      ///< coarse local cell; -1: not on this rank
  std::vector<GlobalIndex> cell_parent_id;  ///< its id
  std::vector<ChildShape> cell_shape;       ///< how the cell lies in it
  std::vector<std::array<LocalIndex, 2>>
      vertex_parents;  ///< coarse local vertices; both the same for a vertex of the coarse level; -1: not here

  Refinement refinement = Refinement::red;  ///< towards the next finer level
  Chart chart = Chart::identity;
};

struct Adaptive;

/// Nested meshes, coarsest first: uniform refinements, then adaptive ones.
struct Hierarchy {
  std::deque<Mesh> levels;           ///< references to them stay valid when levels are appended
  std::shared_ptr<const Mesh> root;  ///< the coarsest mesh, whole on every rank, alone on its communicator, ids = local numbers
  int partitioned = 0;               ///< the level whose cells were shared out to the ranks

  std::shared_ptr<const Adaptive> adaptive;  ///< what mesh::adapt goes on from; null without adaptive levels
  const Mesh& finest() const { return levels.back(); }
};

}  // namespace thixis::mesh
