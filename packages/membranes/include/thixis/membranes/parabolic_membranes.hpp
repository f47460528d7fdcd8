#pragma once
#include <memory>
#include <optional>

#include "thixis/algebra/solver.hpp"
#include "thixis/membranes/scene.hpp"
#include "thixis/method/method.hpp"
#include "thixis/models/evolution.hpp"

namespace thixis::membranes {

/// Contact between two membranes in time (docs/methods/parabolic.md), by backward Euler:
///
///     d_t u1 - div(mu1 grad u1) - lambda = f1,   d_t u2 - div(mu2 grad u2) + lambda = f2,
///     u1 - u2 >= 0,  lambda >= 0,  (u1 - u2) lambda = 0,      u1, u2 given at time 0.
///
/// `by`: the method. `friedrichs`: of bound::StepBound.
std::unique_ptr<models::UnsteadyModel> parabolic_membranes(MembraneScene scene, method::Method by, method::MethodParams method,
                                                           algebra::LinearParams linear, std::optional<double> friedrichs = {});

}  // namespace thixis::membranes
