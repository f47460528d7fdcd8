#pragma once
#include "thixis/method/form.hpp"

namespace thixis::hho {

/// Hybrid high-order: polynomials of degree p = 1…4 in the cells, whose coefficients are the contact points, and of degree p-1 on the
/// faces, in a basis that is orthonormal on [0,1] along the face; Dirichlet faces are held (docs/methods/hho.md). Collective. The mesh must
/// outlive the space.
std::unique_ptr<method::Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options);

/// (mu G u, G v) with its stabilization, as the options of the space say; the energy is ∫ mu |grad u_K|². Scalar spaces, which must outlive
/// it.
method::FormPtr diffusion(const method::Space& space, const scene::FieldPtr& tension);

}  // namespace thixis::hho
