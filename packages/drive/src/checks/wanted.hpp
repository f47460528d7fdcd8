#pragma once
#include <map>
#include <string>
#include <vector>

#include "thixis/drive/run.hpp"

namespace thixis::drive {

/// The values that `expect` asks for among all fields at its points, [point][field].
std::map<std::string, double> values_by_name(const ExpectParams& expect, const std::vector<std::string>& fields,
                                             const std::vector<double>& values);

}  // namespace thixis::drive
