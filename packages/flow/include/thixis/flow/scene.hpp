#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "thixis/flow/params.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::flow {

struct FlowState {
  scene::FieldPtr s_g, P, chi;  ///< gas saturation, pressure of the liquid [Pa], molar fraction of dissolved hydrogen
};

struct FlowBoundary {
  FlowBoundaryKind kind = FlowBoundaryKind::no_flow;
  scene::FieldPtr water, hydrogen;  ///< flux: kg per m^2 and unit of time, into the domain
  FlowState state;                  ///< state
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
  std::vector<double> jumps;                      ///< times at which rates jump, in time_unit: steps end there
  scene::FieldPtr water_source, hydrogen_source;  ///< kg per m^3 and unit of time
  std::map<std::string, FlowBoundary> boundary;   ///< by tag; no flow through the others
};

/// The problem that the block describes. Throws InputError with one line "scene/<path>: <sentence>" per mistake.
TwoPhaseScene two_phase_scene(const models::SceneParams& params);

}  // namespace thixis::flow
