#pragma once
#include <string>

#include "thixis/core/error.hpp"
#include "thixis/drive/stationary.hpp"

namespace thixis::drive {

struct Verdict {
  core::ExitCode code = core::ExitCode::done;
  std::string sentence;
};

/// Did the run do what was asked, in one sentence.
Verdict judge(const RunParams& params, const Outcome& outcome);

}  // namespace thixis::drive
