#pragma once
#include "thixis/core/uses.hpp"
#include "thixis/models/params.hpp"

namespace thixis::membranes {

/// When the functions of the deck take part.
void add_uses(core::Uses<models::RunParams>& uses);

}  // namespace thixis::membranes
