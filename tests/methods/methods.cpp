#include "methods.hpp"

#include <algorithm>

#include "thixis/core/deck.hpp"

namespace thixis::tests {

bool is_built(const std::string& name) {
  const auto& methods = catalogue().methods();
  return std::any_of(methods.begin(), methods.end(), [&](const method::Method& known) { return known.name == name; });
}

const method::Method& method_of(const std::string& name) { return catalogue().method(name); }

method::MethodParams with(method::MethodParams method, const std::map<std::string, std::string>& entries) {
  if (!is_built(method.name)) return method;
  auto deck = core::Deck::from_text("<ParameterList name=\"thixis\"/>", "method");
  deck.set("scene/model=membranes");
  deck.set("scene/case=disk");
  deck.set("method/name=" + method.name);
  for (const auto& [name, value] : entries) deck.set("method/" + name + "=" + value);
  method.own = deck.parse(catalogue().schema()).method.own;
  return method;
}

}  // namespace thixis::tests
