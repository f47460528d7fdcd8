#pragma once
#include "thixis/method/space.hpp"

namespace thixis::dg {

/// Interior-penalty discontinuous Galerkin of degree p = 1 … 4, SIPG or NIPG (docs/methods/dg.md). The mesh must outlive the space.
/// Collective.
std::unique_ptr<method::Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options);

}  // namespace thixis::dg
