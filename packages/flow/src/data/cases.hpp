#pragma once
#include <string>
#include <vector>

#include "thixis/flow/scene.hpp"
#include "thixis/models/entry.hpp"

namespace thixis::flow {

const std::vector<models::Case>& cases();

/// A case, one of cases(), with the medium (and, where they are given, the capillary law and the gravity) of the deck: what hangs on them,
/// e.g. a hydrostatic pressure, does so here, too.
TwoPhaseScene catalogue(const std::string& name, const FlowParams& given);

}  // namespace thixis::flow
