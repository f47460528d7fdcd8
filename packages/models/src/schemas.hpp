#pragma once
#include "thixis/models/catalogue.hpp"

namespace thixis::models {

/// Names of the entries that `chosen` holds for, in their order.
template <class Entries, class Chosen>
std::vector<std::string> names_of(const Entries& entries, Chosen chosen) {
  std::vector<std::string> names;
  for (const auto& entry : entries)
    if (chosen(entry)) names.push_back(entry.name);
  return names;
}
/// "a, b or c".
std::string either(const std::vector<std::string>& names);

core::Schema<SceneParams> scene_schema(const Catalogue& catalogue);
core::Schema<complementarity::NewtonParams> newton_schema(const Catalogue& catalogue);
core::Schema<OutputParams> output_schema(const Catalogue& catalogue);
core::Schema<ExpectParams> expect_schema(const Catalogue& catalogue);
core::Schema<RunParams> deck_schema(const Catalogue& catalogue);
core::Uses<RunParams> uses_of(const Catalogue& catalogue);

}  // namespace thixis::models
