#pragma once
#include "thixis/drive/stationary.hpp"

namespace thixis::drive {

/// The expectations that the outcome misses, a clause each: "energy error 2.1e-03 is above 2.0e-03". Where nothing was to be solved only
/// the counts are judged.
std::vector<std::string> missed(const ExpectParams& expect, const Outcome& outcome, long long cells);

}  // namespace thixis::drive
