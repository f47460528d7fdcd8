#include "thixis/core/uses.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {
namespace {

/// The line in front of a message "file:line: ..."; assignments, "--set ...", come first.
long long line_of(const std::string& message, const std::string& file) {
  if (message.rfind(file + ":", 0) != 0) return -1;
  return to_integer(message.substr(file.size() + 1, message.find(':', file.size() + 1) - file.size() - 1)).value_or(-1);
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

}  // namespace thixis::core
