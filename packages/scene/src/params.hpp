#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "thixis/scene/membranes.hpp"

namespace thixis::scene {

/// Where `data` and a part of `boundary` hold the functions of one membrane.
struct MembraneEntries {
  std::string index;  ///< of their names: "1", "2"; none over an obstacle
  core::Formula DataParams::*mu;
  core::Formula DataParams::*f;
  core::Formula DataParams::*g;
  core::Formula DataParams::*u;
  core::Formula DataParams::*u_x;
  core::Formula DataParams::*u_y;
  core::Formula BoundaryParams::*g_here;
  core::Formula BoundaryParams::*t_here;
};

/// The membranes of a model, the upper one first; none if it is about something else.
std::vector<MembraneEntries> membranes_of(Model model);

using Report = std::function<void(const std::string& path, const std::string& sentence)>;
using Constants = std::map<std::string, double>;

/// Calls report(path relative to the block `scene`, sentence) for everything in the block that can not be meant.
void examine(const SceneParams& params, const Report& report);
/// The same for the sublist `flow`.
void examine_flow(const FlowParams& flow, const Report& report);
/// The same for one expression, if it is given, and for the names of constants at `path`.
void examine_formula(const std::string& path, const core::Formula& formula, const Constants& constants, const Report& report);
void examine_constants(const std::string& path, const Constants& constants, const Report& report);

}  // namespace thixis::scene
