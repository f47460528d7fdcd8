#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>

#include "thixis/membranes/params.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::membranes {

/// Condition on one part of the boundary, for every membrane.
struct BoundaryCondition {
  BoundaryKind kind = BoundaryKind::dirichlet;
  scene::FieldPtr value[2];  ///< g_alpha or t_alpha; null for every membrane: none was given
};

/// The exact solution, index alpha of a membrane first. Across the interface only the second derivatives and lambda may jump.
struct ExactMembranes {
  scene::FieldPtr u[2];
  std::array<scene::FieldPtr, 2> gradient[2];  ///< gradient[alpha][direction]; null: not given, to be had by differences of u
  scene::FieldPtr multiplier;                  ///< lambda; may be null
};

/// Two membranes in contact (docs/methods/membranes.md): find u_1, u_2, lambda with
///
///     -div(mu_1 grad u_1) - lambda = f_1,   -div(mu_2 grad u_2) + lambda = f_2,   u_1 - u_2 >= 0,  lambda >= 0,  (u_1 - u_2) lambda = 0.
///
/// Index 0 is the upper membrane u_1, index 1 the lower one u_2. Or one membrane over an obstacle psi, u_2 = psi being given:
///
///     -div(mu grad u) - lambda = f,   u - psi >= 0,  lambda >= 0,  (u - psi) lambda = 0;
///
/// then only index 0 of the arrays is used, and the others are null. Or two membranes in time (docs/methods/parabolic.md), with d_t u_alpha
/// beside the divergence: all functions but the tensions may depend on t.
struct MembraneScene {
  std::string name;            ///< of the case, or "data"
  std::string sentence;        ///< what it shows
  int count = 2;               ///< of the membranes: 2, or 1 over an obstacle
  scene::FieldPtr obstacle;    ///< psi; null for two membranes
  scene::FieldPtr tension[2];  ///< mu_alpha; a varying one may be <= 0 somewhere: to be checked where it is evaluated
  scene::FieldPtr force[2];    ///< f_alpha
  std::map<std::string, BoundaryCondition> boundary;  ///< by tag
  BoundaryCondition default_boundary;                 ///< of the tags that `boundary` does not name; its values may be null
  std::optional<ExactMembranes> exact;
  scene::FieldPtr interface_level_set;  ///< zero on the curves across which data jump; may be null
  scene::FieldPtr initial[3];  ///< u_1, u_2, lambda from which a cold start begins (u_1 = u over an obstacle); null: zero. In time:
                               ///< u_1, u_2 at t = 0; null: the exact solution
};

/// The problem that the block describes. Throws InputError with one line "scene/<path>: <sentence>" per mistake (those of the schema's
/// check), and for models of something else.
MembraneScene membrane_scene(const models::SceneParams& params);

}  // namespace thixis::membranes
