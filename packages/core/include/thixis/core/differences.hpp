#pragma once
#include <optional>
#include <string>
#include <vector>

#include "thixis/core/schema.hpp"

namespace thixis::core {

/// A parameter that has another value now than before; no value: it is not given.
struct Difference {
  std::string path;
  std::optional<std::string> before, now;
  std::string sentence() const;  ///< "newton/max iterations = 200 (was 3)"; long values are shortened
};

/// The parameters in which `now` is not as `before`, in the order of the description, those that are gone last.
std::vector<Difference> differences(const Description& root, const void* before, const void* now);
template <class P>
std::vector<Difference> differences(const Schema<P>& schema, const P& before, const P& now) {
  return differences(schema.description(), &before, &now);
}

}  // namespace thixis::core
