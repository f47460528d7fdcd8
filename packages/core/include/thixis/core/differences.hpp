#pragma once
#include <string>
#include <vector>

#include "thixis/core/schema.hpp"

namespace thixis::core {

/// The parameters in which `now` is not as `before`, one text each: "newton/max iterations = 200 (was 3)".
std::vector<std::string> differences(const Description& root, const void* before, const void* now);
template <class P>
std::vector<std::string> differences(const Schema<P>& schema, const P& before, const P& now) {
  return differences(schema.description(), &before, &now);
}

}  // namespace thixis::core
