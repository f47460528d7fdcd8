#pragma once
#include "thixis/mesh/to_view.hpp"

namespace thixis::equilibration {

using mesh::to_view;

}  // namespace thixis::equilibration
