#pragma once
#include "scene/boundary.hpp"

namespace thixis::membranes {

/// Throws InputError for a piece of the mesh no face of whose boundary is held: there the membranes float, whatever holds the rest of them.
/// A piece is what hangs together by faces: a vertex alone holds no membrane. Names the piece by one of its vertices and the parts of its
/// boundary. No rank sees more than its own cells and how the pieces of all ranks touch. Collective.
void check_pieces(const MembraneScene& scene, const Boundary& boundary, const mesh::Mesh& mesh);

}  // namespace thixis::membranes
