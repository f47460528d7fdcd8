#pragma once
#include <map>
#include <string>
#include <vector>

#include "thixis/scene/membranes.hpp"

namespace thixis::scene {

/// A case with what its `interface` may be written in.
struct CatalogueEntry {
  MembraneScene scene;
  std::vector<double> centre;
  std::map<std::string, double> constants;
};

/// The case of this name, which is one of cases(), of membranes.
CatalogueEntry catalogue(const std::string& name);

/// A case of two-phase flow, one of cases(), with the medium (and, where they are given, the capillary law and the gravity) of the deck:
/// what hangs on them, e.g. a hydrostatic pressure, does so here, too.
TwoPhaseScene flow_catalogue(const std::string& name, const FlowParams& given);

}  // namespace thixis::scene
