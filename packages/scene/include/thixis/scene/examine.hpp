#pragma once
#include <functional>
#include <map>
#include <string>

#include "thixis/core/description.hpp"

namespace thixis::scene {

/// Where what can not be meant is told: the path relative to the block that is examined, and a sentence that says what to write instead.
using Report = std::function<void(const std::string& path, const std::string& sentence)>;
using Constants = std::map<std::string, double>;

/// Reports an expression of x, y, t, r and the constants, if it is given and can not be read or is no finite number.
void examine_formula(const std::string& path, const core::Formula& formula, const Constants& constants, const Report& report);
/// Reports names below `path` that expressions can not use.
void examine_constants(const std::string& path, const Constants& constants, const Report& report);

}  // namespace thixis::scene
