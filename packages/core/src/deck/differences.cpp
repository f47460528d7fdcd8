#include "thixis/core/differences.hpp"

#include <fmt/core.h>

#include <map>

#include "deck/block_reader.hpp"
#include "deck/values.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {
namespace {

/// The values as the deck has them, by path, in the order of the description.
using Values = std::vector<std::pair<std::string, std::string>>;

void collect_value(const Description::Parameter& parameter, const void* object, const std::string& path, Values& values) {
  if (const auto value = write_value(parameter, object)) values.emplace_back(path, value->text);
}

void collect_values(const Description& description, const void* object, const std::string& path, Values& values) {
  for (const auto& parameter : description.parameters()) collect_value(parameter, object, joined_path(path, parameter.name), values);
  for (const auto& block : description.blocks())
    for (const auto& [name, member] : block.members(object)) {
      const std::string inside = joined_path(path, block.single ? block.name : joined_path(block.name, name));
      if (block.inside) collect_values(*block.inside, member, inside, values);
      else collect_value(*block.value, member, inside, values);
    }
}

std::string shown(const std::optional<std::string>& value) {
  constexpr std::size_t most = 60;
  return value ? shortened(*value, most) : "not given";
}

}  // namespace

std::string Difference::sentence() const { return fmt::format("{} = {} (was {})", path, shown(now), shown(before)); }

std::vector<Difference> differences(const Description& root, const void* before, const void* now) {
  Values old, fresh;
  collect_values(root, before, "", old);
  collect_values(root, now, "", fresh);
  const std::map<std::string, std::string> were(old.begin(), old.end()), are(fresh.begin(), fresh.end());
  std::vector<Difference> found;
  for (const auto& [path, value] : fresh) {
    const auto was = were.find(path);
    if (was == were.end()) found.push_back({path, std::nullopt, value});
    else if (was->second != value) found.push_back({path, was->second, value});
  }
  for (const auto& [path, value] : old)
    if (are.count(path) == 0) found.push_back({path, value, std::nullopt});
  return found;
}

}  // namespace thixis::core
