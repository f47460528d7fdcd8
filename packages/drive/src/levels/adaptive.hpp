#pragma once
#include "levels/level_solver.hpp"

namespace thixis::drive {

/// From the solution on the finest level on: estimate, mark, refine, solve, until the bound is at most stopping/target or a limit of
/// `adapt` is reached. The last solution stays in the outcome of the solver; where the target was missed, the one with the smallest bound.
void solve_adaptively(LevelSolver& solver, mesh::Hierarchy& hierarchy, const RunParams& params, const Observer& observer);

/// Whether an adaptive run may solve on this mesh (adapt/max unknowns), and what ends it otherwise.
bool allowed(const models::Discretization& discretization, const RunParams& params);
std::string too_many_unknowns(const RunParams& params);
/// What to try then.
constexpr const char* more_unknowns = "allow more of them, or take a higher method/degree";

/// Throws InputError if the mesh that the run begins with has more unknowns than it may have.
void require_allowed(const models::Discretization& discretization, const RunParams& params);

}  // namespace thixis::drive
