#pragma once
#include "thixis/method/form.hpp"

namespace thixis::dg {

/// Discontinuous polynomials of degree p = 1 … 4 (docs/methods/dg.md). The mesh must outlive the space. Collective.
std::unique_ptr<method::Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options);

/// The interior-penalty form of (mu grad u, grad v), SIPG or NIPG as the options of the space say, with Dirichlet data g by
/// - theta (mu grad(psi)·n, g)_F + (eta p²/|F|) (mu g, psi)_F on the boundary unless nodes are held there. Energy: ∫ mu |grad u|² in the
/// cells. Scalar spaces, which must outlive it.
method::FormPtr diffusion(const method::Space& space, const scene::FieldPtr& tension);

/// The penalty eta above which SIPG is positive definite whatever the solution is (docs/methods/dg.md, 2), for a constant tension:
///
///     max_K (1 + 1/p)/4 Σ_{F of K} w_F |F|²/|K|,   w_F = 1 inside, 2 with weak Dirichlet data, 0 elsewhere.        Collective.
double sufficient_penalty(const mesh::Mesh& mesh, const method::SpaceOptions& options);

/// Throws InputError where SIPG has a penalty below that: it may then have wrong solutions. Collective.
void check_mesh(const mesh::Mesh& mesh, const method::SpaceOptions& options);

}  // namespace thixis::dg
