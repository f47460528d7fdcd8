#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "thixis/core/schema.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::scene {

struct SceneParams;

// -- sublist `flow` of the block `scene` --------------------------------------------------------------------------------------------

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

// -- the continuous problem ---------------------------------------------------------------------------------------------------------

struct FlowState {
  FieldPtr s_g, P, chi;  ///< gas saturation, pressure of the liquid [Pa], molar fraction of dissolved hydrogen
};

struct FlowBoundary {
  FlowBoundaryKind kind = FlowBoundaryKind::no_flow;
  FieldPtr water, hydrogen;  ///< flux: kg per m^2 and unit of time, into the domain
  FlowState state;           ///< state
};

/// Water and hydrogen in a porous rock, in a liquid and a gas phase that may be absent (docs/methods/two_phase.md).
/// Lengths in m; rates per unit of time of the deck, in which t is measured, too; everything else in SI units.
struct TwoPhaseScene {
  std::string name;       ///< of the case, or "flow"
  std::string sentence;   ///< what it shows
  std::string time_unit;  ///< "year" where the rates of a case are meant per year; empty: whatever the deck says
  RockAndFluids medium;
  CapillaryLaw capillary_law = CapillaryLaw::van_genuchten;
  std::array<double, 2> gravity = {0, 0};  ///< g [m/s^2]
  FlowState initial;
  std::vector<double> jumps;                     ///< times at which rates jump, in time_unit: steps end there
  FieldPtr water_source, hydrogen_source;        ///< kg per m^3 and unit of time
  std::map<std::string, FlowBoundary> boundary;  ///< by tag; no flow through the others
};

/// The problem that the block describes. Throws InputError with one line "scene/<path>: <sentence>" per mistake.
TwoPhaseScene two_phase_scene(const SceneParams& params);

}  // namespace thixis::scene
