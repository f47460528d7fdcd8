#pragma once
#include <string>

namespace thixis::mesh {

/// What is wrong with coordinates of this size at cells of this length, or nothing: areas and their products with data must be numbers,
/// too, and coordinates must have digits left for the cells. `coordinate`, `length`: absolute values.
std::string lengths_mistake(double coordinate, double length);

}  // namespace thixis::mesh
