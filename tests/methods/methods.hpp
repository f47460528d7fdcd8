#pragma once
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "registry.hpp"

/// Methods in tests, by name. Those that the program does not have are reported as not built.
namespace thixis::tests {

bool is_built(const std::string& name);

/// Ends a test of a method that the program does not have.
#define SKIP_UNLESS_BUILT(name) \
  if (!::thixis::tests::is_built(name)) GTEST_SKIP() << (name) << " is not built"

inline const std::string& method_in(const std::string& name) { return name; }
template <class T>
auto method_in(const T& setting) -> decltype((setting.name)) {
  return setting.name;
}
template <class T, class U>
const T& method_in(const std::pair<T, U>& setting) {
  return setting.first;
}

/// Of names, of pairs that begin with one, or of settings with a member `name`: those whose method is there.
template <class T>
std::vector<T> built(std::vector<T> settings) {
  std::vector<T> here;
  for (const T& setting : settings)
    if (is_built(method_in(setting))) here.push_back(setting);
  return here;
}
inline std::vector<std::string> built(std::initializer_list<const char*> names) {
  return built(std::vector<std::string>(names.begin(), names.end()));
}

/// The spaces of a method.
const method::Method& method_of(const std::string& name);

/// The block `method` with further entries, as the deck writes them; as it was where the method is not built.
method::MethodParams with(method::MethodParams method, const std::map<std::string, std::string>& entries);

}  // namespace thixis::tests
