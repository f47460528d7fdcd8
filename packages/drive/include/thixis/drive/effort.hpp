#pragma once

namespace thixis::drive {

/// What a run has taken so far, failed attempts included. Behind a restart everything that was done before it counts, too.
struct Effort {
  int newton_iterations = 0, linear_iterations = 0;
};

}  // namespace thixis::drive
