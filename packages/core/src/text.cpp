#include "thixis/core/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>

namespace thixis::core {

namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Levenshtein's distance, one row of the table at a time.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::size_t common_beginning(const std::string& a, const std::string& b) {
  std::size_t length = 0;
  while (length < std::min(a.size(), b.size()) && a[length] == b[length]) ++length;
  return length;
}

std::string trimmed(const std::string& text) {
  constexpr const char* blanks = " \t\r\n";
  const auto begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// std::from_chars knows no leading plus sign.
std::string number_part(const std::string& text) {
  std::string number = trimmed(text);
  if (number.size() > 1 && number[0] == '+' && number[1] != '-') number.erase(0, 1);
  return number;
}

/// A character of UTF-8; no bytes: there is none that is written in its shortest form and allowed to be written.
struct Character {
  unsigned long code = 0;
  std::size_t bytes = 0;
};

Character character_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t k) { return at + k < text.size() ? static_cast<unsigned char>(text[at + k]) : 0u; };
  const unsigned first = byte(0);
  const std::size_t bytes = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
  unsigned long code = bytes < 2 ? first : first & (0x7fu >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xc0u) != 0x80u) return {};
    code = code << 6 | (byte(k) & 0x3fu);
  }
  constexpr unsigned long least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  return code < least[bytes] || surrogate || code > 0x10ffff ? Character{} : Character{code, bytes};
}

bool is_control(unsigned long code) { return code < 0x20 || (code >= 0x7f && code < 0xa0); }
/// U+202A ... U+202E and U+2066 ... U+2069: what follows is shown in another order than it is read.
bool turns_direction(unsigned long code) { return (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069); }

std::string escaped(const std::string& text, const char* kept) {
  std::string safe;
  for (std::size_t i = 0; i < text.size();) {
    const Character found = character_at(text, i);
    const std::size_t bytes = std::max<std::size_t>(found.bytes, 1);
    const std::string shown = text.substr(i, bytes);
    const bool stays = found.code != 0 && std::string(kept).find(shown) != std::string::npos;
    if (found.bytes == 0) safe += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
    else if (is_control(found.code) && !stays) safe += fmt::format("\\x{:02x}", found.code);
    else if (turns_direction(found.code)) safe += fmt::format("\\u{:04x}", found.code);
    else safe += shown;
    i += bytes;
  }
  return safe;
}

template <class T>
std::optional<T> parsed(const std::string& text) {
  const std::string number = number_part(text);
  T value{};
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<std::string> nearest(const std::string& name, const std::vector<std::string>& candidates) {
  std::optional<std::string> best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1, most_common = 0;
  for (const auto& candidate : candidates) {
    const std::string a = lower(name), b = lower(candidate);
    const std::size_t distance = edit_distance(a, b), common = common_beginning(a, b);
    const bool nearer = distance < least || (best && distance == least && common > most_common);
    // If every letter has to change, the names have nothing in common.
    if (nearer && distance < std::max(a.size(), b.size())) least = distance, most_common = common, best = candidate;
  }
  return best;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates, const std::string& otherwise) {
  if (const auto near = nearest(name, candidates)) return fmt::format("Did you mean '{}'?", *near);
  return fmt::format("{} {}.", otherwise, join(candidates));
}

std::string join(const std::vector<std::string>& words, const std::string& separator) {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : separator) + word;
  return all;
}

std::string printable(const std::string& text) { return escaped(text, "\n\t"); }
std::string one_line(const std::string& text) { return escaped(text, ""); }

std::size_t first_unprintable(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const Character found = character_at(text, i);
    const bool blank = found.code == '\t' || found.code == '\n' || found.code == '\r';
    if (found.bytes == 0 || (is_control(found.code) && !blank)) return i;
    i += found.bytes;
  }
  return std::string::npos;
}

std::string shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  const auto inside = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xc0u) == 0x80u; };
  std::size_t end = most / 2, begin = text.size() - most / 2;
  while (end > 0 && inside(end)) --end;
  while (begin < text.size() && inside(begin)) ++begin;
  return text.substr(0, end) + " ... " + text.substr(begin);
}

std::optional<double> to_double(const std::string& text) {
  const auto value = parsed<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<long long> to_integer(const std::string& text) { return parsed<long long>(text); }

std::string to_text(double value) {
  std::string text = fmt::format("{}", value);
  const auto exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  // 1e-08 reads better as 1e-8.
  auto digits = exponent + 1;
  if (text[digits] == '+') text.erase(digits, 1);
  if (text[digits] == '-') ++digits;
  while (digits + 1 < text.size() && text[digits] == '0') text.erase(digits, 1);
  return text;
}

}  // namespace thixis::core
