#pragma once
#include "thixis/method/space.hpp"

namespace thixis::dg {

/// Interior-penalty discontinuous Galerkin of degree p = 1 … 4, SIPG or NIPG (docs/methods/dg.md). The mesh must outlive the space.
/// Collective.
std::unique_ptr<method::Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options);

/// The penalty eta above which SIPG is positive definite whatever the solution is (docs/methods/dg.md, 2), for a constant tension:
///
///     max_K (1 + 1/p)/4 Σ_{F of K} w_F |F|²/|K|,   w_F = 1 inside, 2 with weak Dirichlet data, 0 elsewhere.        Collective.
double sufficient_penalty(const mesh::Mesh& mesh, const method::SpaceOptions& options);

/// Throws InputError where SIPG has a penalty below that: it may then have wrong solutions. Collective.
void check_mesh(const mesh::Mesh& mesh, const method::SpaceOptions& options);

}  // namespace thixis::dg
