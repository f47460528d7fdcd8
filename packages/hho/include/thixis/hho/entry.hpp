#pragma once
#include "thixis/method/method.hpp"

namespace thixis::hho {

/// What the program knows of this method.
method::Method entry();

}  // namespace thixis::hho
