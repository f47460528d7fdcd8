#pragma once
#include "thixis/core/schema.hpp"

namespace thixis::hho {

/// What h is in the stabilization.
enum class StabilizationLength { face, cell };

/// What HHO has in the block `method` for itself: MethodParams::own.
struct Params {
  double stabilization = 10;  ///< kappa
  StabilizationLength stabilization_length = StabilizationLength::face;
  static const core::Schema<Params>& schema();
};

}  // namespace thixis::hho
