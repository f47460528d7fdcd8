#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "thixis/models/params.hpp"

namespace thixis::flow {

/// The model, as in the deck.
constexpr const char* model_name = "two-phase";

enum class CapillaryLaw {
  van_genuchten,
  quadratic  ///< a s_g + b s_g^2 for s_g <= 0.1, with value and slope of van Genuchten's law at 0.1, which holds beyond
};

enum class FlowBoundaryKind { no_flow, flux, state };

/// A state of the fluids: numbers or expressions of x, y, t, r, pi and the constants. Not given: s_g = 0, P = 1e6 Pa, chi = 0.
struct FlowStateParams {
  core::Formula S, s_g;  ///< one of them: S = 1 - s_g
  core::Formula P, chi;
  static const core::Schema<FlowStateParams>& schema();
};

/// One sublist of `flow/boundary`, for the part of the boundary whose tag is its name.
struct FlowBoundaryParams : FlowStateParams {
  FlowBoundaryKind kind = FlowBoundaryKind::no_flow;
  core::Formula water, hydrogen;  ///< flux: kg per m^2 and unit of time, into the domain
  static const core::Schema<FlowBoundaryParams>& schema();
};

/// Rock and fluids, in SI units: the same in all places and at all times. The defaults are those of the gas injection benchmark of MoMaS.
struct RockAndFluids {
  double porosity = 0.15, permeability = 5e-20;                ///< -, m^2
  double viscosity_water = 1e-3, viscosity_hydrogen = 9e-6;    ///< Pa s
  double density_water = 1000;                                 ///< kg/m^3
  double diffusion = 3e-9;                                     ///< m^2/s, of dissolved hydrogen
  double molar_mass_water = 1e-2, molar_mass_hydrogen = 2e-3;  ///< kg/mol
  double henry = 7.65e-6;                                      ///< mol/(Pa m^3)
  double temperature = 303;                                    ///< K
  double n = 1.49, P_r = 2e6;                                  ///< van Genuchten: -, Pa
  double S_lr = 0.4, S_gr = 0;                                 ///< residual saturations
  double regularization = 1e-5;                                ///< eps, in S_e
};

/// Sublist `flow`: what is not given is that of the case, or else the default.
struct FlowParams : RockAndFluids {
  std::optional<CapillaryLaw> capillary_law;
  std::vector<double> gravity;  ///< m/s^2, two components; empty: not given
  FlowStateParams initial;
  core::Formula water_source, hydrogen_source;  ///< kg per m^3 and unit of time
  std::map<std::string, FlowBoundaryParams> boundary;
  std::map<std::string, double> constants;
  static const core::Schema<FlowParams>& schema();
};

/// What scenes of flow have in the block `scene` for themselves (models::SceneParams::own).
struct SceneParams {
  std::optional<FlowParams> flow;
  static const core::Schema<SceneParams>& schema();
};
inline SceneParams& of(models::SceneParams& scene) { return scene.own.get<SceneParams>(); }
inline const SceneParams& of(const models::SceneParams& scene) { return scene.own.get<SceneParams>(); }

/// What they have in the block `expect` for themselves (models::ExpectParams::own).
struct ExpectParams {
  std::optional<double> water_balance_at_most, hydrogen_balance_at_most;
  std::optional<std::vector<double>> front_between;
  static const core::Schema<ExpectParams>& schema();
};

}  // namespace thixis::flow
