#include "gmsh/msh_source.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "thixis/core/error.hpp"

namespace thixis::mesh {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_space(char c) { return is_blank(c) || c == '\n'; }

std::string quoted(std::string_view text) { return "'" + printable(text) + "'"; }

}  // namespace

std::string printable(std::string_view text) {
  std::string shown(text.substr(0, 40));
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
  return shown + (text.size() > 40 ? "..." : "");
}

void MshSource::fail(const std::string& what) const {
  std::size_t end = at_;  // of what has been read
  while (end > 0 && is_space(bytes_[end - 1])) --end;
  const auto lines = std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(end), '\n');
  const std::string place = binary_ ? "byte " + std::to_string(at_) : "line " + std::to_string(lines + 1);
  throw core::InputError(name_ + ", " + place + ": " + what + "; correct it, or save the mesh anew.");
}

void MshSource::skip_blanks() {
  while (!at_end() && is_blank(bytes_[at_])) ++at_;
}
void MshSource::skip_space() {
  while (!at_end() && is_space(bytes_[at_])) ++at_;
}

std::string MshSource::next_section() {
  skip_space();
  if (at_end()) return "";
  const std::string_view title = word();
  if (title[0] != '$') fail(quoted(title) + " stands outside of all sections");
  section_ = title.substr(1);
  end_line();
  return section_;
}

void MshSource::end_section() {
  skip_space();
  const std::string end = "$End" + section_;
  if (at_end()) fail("the file ends before " + end);
  if (word() != end) fail("the section $" + section_ + " holds more than its counts say");
}

void MshSource::skip_section() {
  const std::string end = "$End" + section_;
  for (auto found = bytes_.find(end, at_); found != std::string::npos; found = bytes_.find(end, found + 1)) {
    const std::size_t after = found + end.size();
    const bool begins_line = binary_ || bytes_[found - 1] == '\n', whole = after == bytes_.size() || is_space(bytes_[after]);
    if (!begins_line || !whole) continue;
    at_ = after;
    return;
  }
  fail("the section " + quoted("$" + section_) + " has no end");
}

void MshSource::enter_binary() {
  binary_ = true;
  int one = integer();
  swapped_ = one == 0x01000000;
  if (one != 1 && !swapped_) fail("the first number of a binary file is 1, but this one is not");
}

std::string_view MshSource::word() {
  skip_blanks();
  const std::size_t begin = at_;
  while (!at_end() && !is_space(bytes_[at_])) ++at_;
  if (at_ == begin) fail("the line ends too early");
  return std::string_view(bytes_).substr(begin, at_ - begin);
}

std::string_view MshSource::text() {
  skip_blanks();
  const std::size_t begin = at_;
  at_ = std::min(bytes_.find('\n', at_), bytes_.size());
  std::size_t end = at_;
  while (end > begin && is_blank(bytes_[end - 1])) --end;
  return std::string_view(bytes_).substr(begin, end - begin);
}

void MshSource::end_line() {
  skip_blanks();
  if (!at_end() && bytes_[at_] != '\n') fail("the line goes on where it should end");
  if (!at_end()) ++at_;
  if (!binary_) skip_space();
}

void MshSource::end_row() {
  if (!binary_) end_line();
}

template <class T>
T MshSource::from_text(const char* kind) {
  std::string_view digits = word();
  if (digits[0] == '$') fail(quoted(digits) + " comes before all that the counts of $" + section_ + " promise");
  const std::string_view shown = digits;
  if (digits[0] == '+') digits.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) fail(quoted(shown) + " is no " + kind);
  return value;
}

template <class T>
T MshSource::number(const char* kind) {
  if (!binary_) return from_text<T>(kind);
  char raw[sizeof(T)];
  if (bytes_.size() - at_ < sizeof raw) fail("the file ends within the section $" + section_);
  bytes_.copy(raw, sizeof raw, at_);
  at_ += sizeof raw;
  if (swapped_) std::reverse(raw, raw + sizeof raw);
  T value;
  std::memcpy(&value, raw, sizeof raw);
  return value;
}

int MshSource::integer() { return number<std::int32_t>("whole number of 32 bits"); }
int MshSource::text_integer() { return from_text<std::int32_t>("whole number of 32 bits"); }
double MshSource::real() { return number<double>("number"); }

std::int64_t MshSource::size() {
  const auto value = number<std::int64_t>("whole number of 64 bits");
  if (value < 0) fail(std::to_string(value) + " is no number of a node or element, and no count");
  return value;
}

double MshSource::coordinate() {
  const double value = real(), largest = 1e100;  // areas and their products stay finite
  if (!(std::abs(value) <= largest)) fail("a coordinate is not finite, or too large to compute with");
  return value;
}

std::size_t MshSource::count(std::int64_t claimed, std::size_t numbers) const {
  const std::size_t least = numbers * (binary_ ? 4 : 2), rest = bytes_.size() - at_ + 1;
  if (claimed < 0 || static_cast<std::uint64_t>(claimed) > rest / least)
    fail("the count " + std::to_string(claimed) + " is more than the file holds");
  return static_cast<std::size_t>(claimed);
}

}  // namespace thixis::mesh
