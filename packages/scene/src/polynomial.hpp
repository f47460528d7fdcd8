#pragma once
#include <map>
#include <optional>
#include <string>

#include "thixis/scene/field.hpp"

namespace thixis::scene {

/// What the text of an expression of x, y, t, r proves of it as a polynomial: sums, differences, products, quotients by constants, and
/// powers with whole numbers of x, y, t and even powers of r; functions of constants are constants. Pieces that conditions, abs, min, max
/// put together give the largest of their degrees and `whole` = false. Nothing where the text proves nothing.
std::optional<Degree> degree_of(const std::string& text, const std::map<std::string, double>& constants);

}  // namespace thixis::scene
