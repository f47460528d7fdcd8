#pragma once
#include "thixis/method/form.hpp"

namespace thixis::fem {

/// Continuous finite elements of degree p = 1 … 4 on triangles (docs/methods/fem.md), with as many components as the options say. p = 1:
/// nodal multiplier, lumped mass as pairing; p >= 2: moments. The mesh must outlive the space. Collective.
std::unique_ptr<method::Space> make_lagrange_space(const mesh::Mesh& mesh, const method::SpaceOptions& options);

}  // namespace thixis::fem
