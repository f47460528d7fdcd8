#pragma once
#include <functional>
#include <string>

#include "thixis/scene/membranes.hpp"

namespace thixis::scene {

/// Calls report(path relative to the block `scene`, sentence) for everything in the block that can not be meant.
void examine(const SceneParams& params, const std::function<void(const std::string& path, const std::string& sentence)>& report);

}  // namespace thixis::scene
