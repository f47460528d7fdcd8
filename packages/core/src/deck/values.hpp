#pragma once
#include <optional>
#include <string>
#include <vector>

#include "thixis/core/description.hpp"

namespace thixis::core {

/// The types that a parameter of this kind may have in the deck; the first is the one we write.
const std::vector<std::string>& types_of(Description::Kind kind);
/// What documents call this kind: "int", "expression".
std::string kind_name(Description::Kind kind);

/// The value of `text`, declared as `type` (empty: not declared), or nothing and what is wrong with it, one sentence each.
std::optional<Description::Value> read_value(const Description::Parameter& parameter, const std::string& type, const std::string& text,
                                             std::vector<std::string>& complaints);

/// A value as it stands in the deck. No text: the deck has no form for it (inf, an absent formula).
struct Written {
  std::string type, text;
};
std::optional<Written> write_value(const Description::Parameter& parameter, const void* object);
/// Some valid value, for a parameter that has no default.
Written example_value(const Description::Parameter& parameter);

}  // namespace thixis::core
