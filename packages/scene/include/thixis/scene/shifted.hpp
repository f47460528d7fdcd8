#pragma once
#include "thixis/scene/field.hpp"

namespace thixis::scene {

/// f + by. Null for null.
FieldPtr shifted(const FieldPtr& f, double by);

}  // namespace thixis::scene
