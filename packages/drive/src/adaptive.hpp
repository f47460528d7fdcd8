#pragma once
#include "level_solver.hpp"

namespace thixis::drive {

/// From the solution on the finest level on: estimate, mark, refine, solve, until the bound is at most stopping/target or a limit of
/// `adapt` is reached. The last solution stays in the outcome of the solver; where the target was missed, the one with the smallest bound.
void solve_adaptively(LevelSolver& solver, mesh::Hierarchy& hierarchy, const RunParams& params, const Observer& observer);

/// Throws InputError if a mesh that the run must begin with has more unknowns than it may have.
void require_allowed(const models::Discretization& discretization, const RunParams& params);

}  // namespace thixis::drive
