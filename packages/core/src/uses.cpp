#include "thixis/core/uses.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "block_reader.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"
#include "values.hpp"

namespace thixis::core {
namespace {

/// The line in front of a message "file:line: ..."; assignments, "--set ...", come first.
long long line_of(const std::string& message, const std::string& file) {
  if (message.rfind(file + ":", 0) != 0) return -1;
  return to_integer(message.substr(file.size() + 1, message.find(':', file.size() + 1) - file.size() - 1)).value_or(-1);
}

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

}  // namespace

std::string Use::advice() const {
  return !sentence.empty() ? sentence : fmt::format("this is used only with {0}; leave it out, or write {0}.", condition);
}

Unused unused(const std::vector<Use>& uses, const void* params) {
  Unused found;
  for (const auto& use : uses)
    if (!use.holds(params)) found.emplace(use.path, &use);
  return found;
}

void check_used(const Deck& deck, const Unused& unused, bool set_alone) {
  std::vector<std::pair<long long, std::string>> mistakes;
  for (const auto& [path, use] : unused) {
    if (!deck.given(path)) continue;
    const std::string message = deck.error(path, use->advice()).what();
    const long long line = line_of(message, deck.file());
    if (!set_alone || line < 0) mistakes.emplace_back(line, message);
  }
  if (mistakes.empty()) return;
  std::stable_sort(mistakes.begin(), mistakes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> lines;
  for (const auto& mistake : mistakes) lines.push_back(mistake.second);
  throw InputError(join(lines, "\n"));
}

std::vector<std::string> differences(const Description& root, const void* a, const void* b) {
  Values of_a, of_b;
  collect_values(root, a, "", of_a);
  collect_values(root, b, "", of_b);
  const std::map<std::string, std::string> in_a(of_a.begin(), of_a.end()), in_b(of_b.begin(), of_b.end());
  std::vector<std::string> paths;
  for (const auto& [path, value] : of_a)
    if (const auto other = in_b.find(path); other == in_b.end() || other->second != value) paths.push_back(path);
  for (const auto& [path, value] : of_b)
    if (in_a.count(path) == 0) paths.push_back(path);
  return paths;
}

}  // namespace thixis::core
