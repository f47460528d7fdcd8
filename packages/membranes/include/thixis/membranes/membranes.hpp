#pragma once
#include <memory>

#include "thixis/algebra/solver.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/membranes/scene.hpp"
#include "thixis/method/method.hpp"
#include "thixis/models/model.hpp"

namespace thixis::membranes {

/// Contact between two membranes, or of one with an obstacle psi (docs/methods/membranes.md):
///
///     -div(mu1 grad u1) - lambda = f1,   -div(mu2 grad u2) + lambda = f2,   u1 - u2 >= 0, lambda >= 0, (u1 - u2) lambda = 0;
///     -div(mu grad u) - lambda = f,                                         u - psi >= 0, lambda >= 0, (u - psi) lambda = 0.
///
/// `by`: the method. `initial`: expressions of the deck for the cold start, u_1 (or u), u_2, lambda (null: those of
/// the scene, else zero).
std::unique_ptr<models::StationaryModel> membranes(MembraneScene scene, method::Method by, method::MethodParams method,
                                                   algebra::LinearParams linear, std::array<scene::FieldPtr, 3> initial);

}  // namespace thixis::membranes
