#pragma once
#include <string>
#include <vector>

#include "thixis/membranes/params.hpp"
#include "thixis/scene/examine.hpp"

namespace thixis::membranes {

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
std::vector<MembraneEntries> membranes_of(const std::string& model);

/// A function of the deck, where it stands.
struct Place {
  std::string block, name;
  const core::Formula& formula;
  std::string path() const { return block + "/" + name; }
};
/// All functions of one membrane, in the same order for every membrane; `params.data` is there.
std::vector<Place> places(const MembraneEntries& membrane, const SceneParams& params);

/// Reports functions of the other model; true if there is none.
bool examine_names(const std::string& model, const SceneParams& params, const scene::Report& report);
/// Reports everything in the block `scene` that can not be meant, by paths relative to it.
void examine(const models::SceneParams& params, const scene::Report& report);

}  // namespace thixis::membranes
