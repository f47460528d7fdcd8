#pragma once
#include "judge/verdict.hpp"
#include "thixis/drive/stationary.hpp"

namespace thixis::drive {

/// How a run at rest ended.
Ending ending(const RunParams& params, const Outcome& outcome);
/// With what the deck expects.
Verdict judge(const RunParams& params, const Outcome& outcome);

}  // namespace thixis::drive
