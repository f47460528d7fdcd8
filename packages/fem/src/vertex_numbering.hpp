#pragma once
#include <vector>

#include "thixis/algebra/fwd.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/method/graph.hpp"

namespace thixis::fem {

/// The unknowns of a space with one node per vertex.
///
/// Owned unknowns are numbered contiguously over the ranks, in the order of local vertices; ghosts follow in the column map.
/// Ownership, ids and the Dirichlet tag of ghost vertices come from their owner, who sees the whole patch.
struct VertexNumbering {
  algebra::MapPtr vertex_map;                ///< owned vertices by mesh id
  std::vector<LocalIndex> owned_vertices;    ///< their local numbers, in the order of vertex_map
  algebra::MapPtr rows, columns;             ///< unknowns: owned; owned and ghosts
  std::vector<LocalIndex> vertex_of_column;  ///< local vertex of a local column
  mesh::View<LocalIndex*> column_of_vertex;  ///< -1: Dirichlet, or not needed on this rank
  std::vector<LocalIndex> dirichlet_tag;     ///< per local vertex: tag of its Dirichlet data, -1 for an unknown (or not needed)
  mesh::View<LocalIndex* [3]> cell_columns;  ///< columns of the vertices of method::patch_cells
};

/// dirichlet[tag]: does this part of the boundary carry Dirichlet data. Collective.
VertexNumbering number_vertices(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet);

}  // namespace thixis::fem
