#include "thixis/mesh/groups.hpp"

#include <algorithm>

#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"

namespace thixis::mesh {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> all_groups(const std::vector<std::string>& tags) {
  std::vector<std::string> all;
  for (const auto& tag : tags)
    for (const auto& group : groups_of(tag))
      if (!contains(all, group)) all.push_back(group);
  return all;
}

}  // namespace

std::vector<std::string> groups_of(const std::string& tag) {
  const std::string between = intersection;
  std::vector<std::string> groups;
  std::size_t begin = 0;
  for (auto end = tag.find(between); end != std::string::npos; end = tag.find(between, begin)) {
    groups.push_back(tag.substr(begin, end - begin));
    begin = end + between.size();
  }
  groups.push_back(tag.substr(begin));
  return groups;
}

bool is_in_group(const std::string& tag, const std::string& group) { return contains(groups_of(tag), group); }

std::vector<std::string> named_groups(const std::vector<std::string>& tags, const std::vector<std::string>& names,
                                      const std::string& block) {
  std::vector<std::string> named(tags.size());
  for (const auto& name : names) {
    bool found = false;
    for (std::size_t part = 0; part < tags.size(); ++part) {
      if (!is_in_group(tags[part], name)) continue;
      if (!named[part].empty())
        throw core::InputError(block + "/" + name + ": some edges of '" + name + "' are in the group '" + named[part] +
                               "' of the mesh, too, and both are named here; name groups without a common edge.");
      named[part] = name;
      found = true;
    }
    if (!found)
      throw core::InputError(block + "/" + name +
                             ": the mesh has no such part of the boundary; write one of: " + core::join(all_groups(tags)) + ".");
  }
  return named;
}

}  // namespace thixis::mesh
