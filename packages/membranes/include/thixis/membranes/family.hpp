#pragma once
#include "thixis/models/entry.hpp"

namespace thixis::membranes {

/// What the program knows of the models `membranes`, `obstacle` and `parabolic membranes`.
models::Family family();

}  // namespace thixis::membranes
