#pragma once
#include "thixis/models/catalogue.hpp"

namespace thixis {

/// What this program can do.
const models::Catalogue& catalogue();

}  // namespace thixis
