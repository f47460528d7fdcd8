#pragma once
#include "thixis/method/space.hpp"

namespace thixis::fem {

/// Continuous Lagrange finite elements of degree p = 1 on triangles (docs/methods/fem.md).
/// The mesh must outlive the space.
std::unique_ptr<method::Space> make_lagrange_space(const mesh::Mesh& mesh, const method::SpaceOptions& options);

}  // namespace thixis::fem
