#include <algorithm>
#include <map>

#include "schemas.hpp"
#include "uses_of_blocks.hpp"

namespace thixis::models {
namespace {

using P = RunParams;
using Uses = core::Uses<P>;

template <class Named>
bool uses(const Named& one, const std::string& path) {
  return std::count(one.uses.begin(), one.uses.end(), path) > 0;
}

/// The paths that some of them use, in order.
template <class Named>
std::vector<std::string> paths(const std::vector<Named>& all) {
  std::vector<std::string> found;
  for (const Named& one : all)
    for (const std::string& path : one.uses)
      if (std::count(found.begin(), found.end(), path) == 0) found.push_back(path);
  return found;
}

/// What the models, and the methods, say that they use is used with them alone. Beyond that an entry counts as used where it `says_nothing`
/// new, or is judged with its block.
template <class Named, class Chosen>
void by_name(Uses& all, const std::vector<Named>& named, const std::string& parameter, Chosen chosen) {
  for (const std::string& path : paths(named)) {
    const auto users = names_of(named, [&](const Named& one) { return uses(one, path); });
    if (users.size() == named.size()) continue;
    all.when(
        path, [path, chosen](const P& p) { return uses(chosen(p), path) || says_nothing(p, path); }, parameter + " = " + either(users));
  }
}

}  // namespace

Uses uses_of(const Catalogue& catalogue) {
  Uses all;
  for (const Family& family : catalogue.families())
    if (family.uses) family.uses(all);
  by_name(all, catalogue.models(), "scene/model", [](const P& p) -> const Entry& { return p.catalogue->model(p); });
  by_name(all, catalogue.methods(), "method/name", [](const P& p) -> const method::Method& { return p.catalogue->method(p); });
  of_the_mesh(all);
  of_the_method(all, catalogue);
  of_newton(all, catalogue);
  of_the_linear_solver(all);
  of_stopping(all, catalogue);
  of_time(all, catalogue);
  return all;
}

}  // namespace thixis::models
