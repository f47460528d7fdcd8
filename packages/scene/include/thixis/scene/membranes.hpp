#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "thixis/core/schema.hpp"
#include "thixis/scene/field.hpp"
#include "thixis/scene/two_phase.hpp"

namespace thixis::scene {

// -- block `scene` of the deck ------------------------------------------------------------------------------------------------------

enum class Model { membranes, obstacle, parabolic_membranes, signorini, two_phase };
std::string to_text(Model model);  ///< as in the deck

enum class BoundaryKind {
  dirichlet,  ///< u_alpha = g_alpha
  neumann     ///< mu_alpha du_alpha/dn = t_alpha, n outward
};

/// Sublist `initial` of `data`: the membranes of a scene in time at t = 0.
struct InitialParams {
  core::Formula u1, u2;
  static const core::Schema<InitialParams>& schema();
};

/// Sublist `data`: the functions of a membrane problem. Each is a number or an expression of x, y, t, r, pi and the constants.
/// Those of the one membrane over an obstacle have no index.
struct DataParams {
  core::Formula mu, mu1, mu2;                      ///< tensions, positive; not given: 1
  core::Formula f, f1, f2;                         ///< forces; not given: 0
  core::Formula g, g1, g2;                         ///< Dirichlet data; not given: the trace of the exact solution
  core::Formula psi;                               ///< the obstacle
  core::Formula u, u1, u2, lambda;                 ///< the exact solution, if known
  core::Formula u_x, u_y, u1_x, u1_y, u2_x, u2_y;  ///< its gradient; not given: differences
  std::optional<InitialParams> initial;            ///< in time; not given: the exact solution at t = 0
  std::optional<int> degree;                       ///< of all data, in every cell, if they are polynomials there
  std::vector<double> centre = {0, 0};             ///< r is the distance to it
  std::map<std::string, double> constants;
  static const core::Schema<DataParams>& schema();
};

/// One sublist of `boundary`, for the boundary part whose tag is its name.
struct BoundaryParams {
  BoundaryKind kind = BoundaryKind::dirichlet;
  core::Formula g, g1, g2;  ///< dirichlet; not given: those of the data
  core::Formula t, t1, t2;  ///< neumann; not given: 0
  static const core::Schema<BoundaryParams>& schema();
};

/// Block `scene`. Its check wants either a case or data (two-phase: a case, a flow, or a case and what is changed in its flow) and reports
/// expressions that can not be read.
struct SceneParams {
  Model model = Model::membranes;
  std::optional<std::string> case_name;  ///< `case` in the deck; one of cases()
  std::optional<DataParams> data;
  std::optional<FlowParams> flow;
  core::Formula interface;  ///< level set; its zero set are the curves across which data jump
  std::map<std::string, BoundaryParams> boundary;
  static const core::Schema<SceneParams>& schema();
};

// -- the continuous problem ---------------------------------------------------------------------------------------------------------

/// Condition on one part of the boundary, for every membrane.
struct BoundaryCondition {
  BoundaryKind kind = BoundaryKind::dirichlet;
  FieldPtr value[2];  ///< g_alpha or t_alpha; null for every membrane: none was given
};

/// The exact solution, index alpha of a membrane first. Across the interface only the second derivatives and lambda may jump.
struct ExactMembranes {
  FieldPtr u[2];
  std::array<FieldPtr, 2> gradient[2];  ///< gradient[alpha][direction]; null: not given, to be had by differences of u
  FieldPtr multiplier;                  ///< lambda; may be null
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
  std::string name;      ///< of the case, or "data"
  std::string sentence;  ///< what it shows
  int count = 2;         ///< of the membranes: 2, or 1 over an obstacle
  FieldPtr obstacle;     ///< psi; null for two membranes
  FieldPtr tension[2];   ///< mu_alpha; a varying one may be <= 0 somewhere: to be checked where it is evaluated
  FieldPtr force[2];     ///< f_alpha
  std::map<std::string, BoundaryCondition> boundary;  ///< by tag
  BoundaryCondition default_boundary;                 ///< of the tags that `boundary` does not name; its values may be null
  std::optional<ExactMembranes> exact;
  FieldPtr interface_level_set;  ///< zero on the curves across which data jump; may be null
  FieldPtr initial[3];           ///< u_1, u_2, lambda from which a cold start begins (u_1 = u over an obstacle); null: zero. In time:
                                 ///< u_1, u_2 at t = 0; null: the exact solution
};

/// A catalogued case (block `scene`, parameter `case`).
struct Case {
  std::string name;
  Model model;
  std::string sentence;
};
const std::vector<Case>& cases();

/// The problem that the block describes. Throws InputError with one line "scene/<path>: <sentence>" per mistake (those of the schema's
/// check), and for models other than membranes, obstacle and parabolic membranes.
MembraneScene membrane_scene(const SceneParams& params);

}  // namespace thixis::scene
