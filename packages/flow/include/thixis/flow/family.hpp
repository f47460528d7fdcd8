#pragma once
#include "thixis/models/entry.hpp"

namespace thixis::flow {

/// What the program knows of the model `two-phase`.
models::Family family();

}  // namespace thixis::flow
