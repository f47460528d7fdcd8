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

/// The case of this name, which is one of cases().
CatalogueEntry catalogue(const std::string& name);

}  // namespace thixis::scene
