#include "thixis/core/differences.hpp"

#include <fmt/core.h>

#include <map>

#include "thixis/core/text.hpp"
#include "xml_reader.hpp"

namespace thixis::core {
namespace {

using Values = std::map<std::string, std::string>;

void collect(const Deck::Entry& list, const std::string& path, Values& values) {
  for (const auto& entry : list.inside) {
    const std::string place = path.empty() ? entry.name : path + "/" + entry.name;
    if (entry.list) collect(entry, place, values);
    else values[place] = entry.value;
  }
}

Values values_of(const Description& root, const void* params) {
  std::vector<Deck::Mistake> none;
  Values values;
  collect(read_xml(to_xml(root, params), root.name(), none), "", values);
  return values;
}

std::string shown(const Values& values, const std::string& path) {
  constexpr std::size_t most = 60;
  const auto found = values.find(path);
  return found == values.end() ? "not given" : shortened(found->second, most);
}

}  // namespace

std::vector<std::string> differences(const Description& root, const void* before, const void* now) {
  const Values old = values_of(root, before), fresh = values_of(root, now);
  Values all = old;
  all.insert(fresh.begin(), fresh.end());
  std::vector<std::string> found;
  for (const auto& entry : all)
    if (const std::string was = shown(old, entry.first), is = shown(fresh, entry.first);
        old.count(entry.first) != fresh.count(entry.first) || (old.count(entry.first) > 0 && old.at(entry.first) != fresh.at(entry.first)))
      found.push_back(fmt::format("{} = {} (was {})", entry.first, is, was));
  return found;
}

}  // namespace thixis::core
