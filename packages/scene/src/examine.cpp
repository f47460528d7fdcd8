#include "thixis/scene/examine.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "thixis/core/error.hpp"
#include "thixis/core/expression.hpp"

namespace thixis::scene {
namespace {

/// Whether expressions may use it.
bool is_right(const Constants::value_type& constant) {
  try {
    const core::Expression nothing("0", {"x", "y", "t", "r"}, {constant});
    return true;
  } catch (const core::InputError&) {
    return false;
  }
}

/// The others are reported by examine_constants.
Constants with_right_names(const Constants& constants) {
  Constants right;
  for (const auto& constant : constants)
    if (is_right(constant)) right.insert(constant);
  return right;
}

}  // namespace

void examine_formula(const std::string& path, const core::Formula& formula, const Constants& constants, const Report& report) {
  if (formula.empty()) return;
  try {
    const core::Expression parsed(formula.text, {"x", "y", "t", "r"}, constants);
    if (parsed.constant() && !std::isfinite(parsed({0, 0, 0, 0}))) report(path, "'" + formula.text + "' is not a finite number.");
  } catch (const core::InputError& error) {
    // wrong names are reported where they stand, and not by every expression that may use them
    const Constants right = with_right_names(constants);
    if (right.size() < constants.size()) return examine_formula(path, formula, right, report);
    report(path, error.what());
  }
}

void examine_constants(const std::string& path, const Constants& constants, const Report& report) {
  const Constants right = with_right_names(constants);
  for (const auto& [name, value] : constants) {
    if (right.count(name) > 0) continue;
    const bool is_name = std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    report(path + "/" + name, is_name && std::isdigit(static_cast<unsigned char>(name[0])) == 0
                                  ? "this name has a meaning in every expression already; take another one."
                                  : "this can not be the name of a constant; use letters, digits and _, a letter first.");
  }
}

}  // namespace thixis::scene
