#pragma once
#include <vector>

#include "thixis/bound/cell_fields.hpp"

namespace thixis::bound {

/// The patches of all vertices of owned cells: for patch a its cells as positions among the patch cells, and which of their vertices it is.
struct VertexPatches {
  View<LocalIndex*> vertex;  ///< of the mesh
  View<LocalIndex*> offset;  ///< entries of patch a: offset(a) … offset(a+1)-1
  View<LocalIndex*> cell;    ///< position
  View<int*> corner;         ///< local vertex of that cell
  LocalIndex size() const { return vertex.extent_int(0); }
};
VertexPatches vertex_patches(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells);

}  // namespace thixis::bound
