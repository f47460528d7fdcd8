#pragma once
#include <vector>

#include "thixis/mesh/locate.hpp"
#include "thixis/method/space.hpp"

namespace thixis::method {

/// u_h at places of the mesh of the space (mesh::locate), on all ranks. Collective.
std::vector<double> values_at(const Space& space, const std::vector<mesh::Place>& places, const Coefficients& u);

}  // namespace thixis::method
