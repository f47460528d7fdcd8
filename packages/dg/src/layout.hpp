#pragma once
#include "thixis/method/space.hpp"

namespace thixis::dg {

/// Dirichlet data fix the nodes on the boundary, instead of entering through the form.
bool strong(const method::SpaceOptions& options);

/// What a face of an owned cell does.
enum class FaceRole { form, held, free };  ///< carries a form (inside, weak data), has held nodes, neither (Neumann)
FaceRole role(LocalIndex tag, const method::SpaceOptions& options);

/// n entries per patch cell. With strong data the nodes on the held boundary are held, also those of cells that meet it at a vertex only.
/// Coupled faces: all of owned cells, those with a form first, then those with held nodes.
method::Structure layout(const mesh::Mesh& mesh, const method::SpaceOptions& options);

}  // namespace thixis::dg
