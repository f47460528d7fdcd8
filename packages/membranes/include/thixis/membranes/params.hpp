#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "thixis/models/params.hpp"

namespace thixis::membranes {

/// The models, as in the deck: two membranes, one over an obstacle, two in time.
namespace model {
constexpr const char *two = "membranes", *obstacle = "obstacle", *in_time = "parabolic membranes";
}

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

/// What scenes of membranes have in the block `scene` for themselves (models::SceneParams::own).
struct SceneParams {
  std::optional<DataParams> data;
  core::Formula interface;  ///< level set; its zero set are the curves across which data jump
  std::map<std::string, BoundaryParams> boundary;
  static const core::Schema<SceneParams>& schema();
};
inline SceneParams& of(models::SceneParams& scene) { return scene.own.get<SceneParams>(); }
inline const SceneParams& of(const models::SceneParams& scene) { return scene.own.get<SceneParams>(); }

/// Block `newton/initial`: the functions a cold start begins with; nothing given is zero inside, or the height closest to zero at which
/// the membranes are held. u1 and u2 are the two membranes, u is the one over an obstacle.
struct StartParams {
  std::optional<core::Formula> u, u1, u2, lambda;
  static const core::Schema<StartParams>& schema();
};
/// What they have in the block `newton` (complementarity::NewtonParams::own).
struct NewtonParams {
  StartParams initial;
  static const core::Schema<NewtonParams>& schema();
};

}  // namespace thixis::membranes
