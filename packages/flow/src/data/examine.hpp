#pragma once
#include "thixis/flow/params.hpp"
#include "thixis/scene/examine.hpp"

namespace thixis::flow {

/// Reports everything in the block `scene` that can not be meant, by paths relative to it.
void examine(const models::SceneParams& params, const scene::Report& report);

}  // namespace thixis::flow
