#include "deck/deck_text.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "thixis/core/text.hpp"

namespace thixis::core {
namespace {

/// Whether it begins with the marks of UTF-16 or UTF-32, or as "<" does there.
bool is_wide(const std::string& text) {
  const std::string begin = text.substr(0, 2);
  return begin == "\xff\xfe" || begin == "\xfe\xff" || begin == std::string("<\0", 2) || begin == std::string("\0<", 2) ||
         begin == std::string("\0\0", 2);
}

/// The characters of XML 1.0 that are none of control.
bool allowed(unsigned long code) {
  const bool blank = code == 0x9 || code == 0xa || code == 0xd;
  const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0), surrogate = code >= 0xd800 && code < 0xe000;
  return blank || !(control || surrogate || code == 0xfffe || code == 0xffff || code > 0x10ffff);
}

/// The number of the reference whose "&#" ends before `at`; too large ones stay too large.
unsigned long referred(const std::string& text, std::size_t at) {
  const bool hexadecimal = at < text.size() && text[at] == 'x';
  const unsigned long base = hexadecimal ? 16 : 10;
  const std::string digits = std::string("0123456789abcdef").substr(0, base);
  unsigned long code = 0;
  for (at += hexadecimal ? 1 : 0; at < text.size(); ++at) {
    const char lower = text[at] >= 'A' && text[at] <= 'F' ? static_cast<char>(text[at] - 'A' + 'a') : text[at];
    const auto digit = digits.find(lower);
    if (digit == std::string::npos) break;
    code = std::min(code * base + digit, 0x110000ul);
  }
  return code;
}

}  // namespace

std::optional<TextMistake> text_mistake(const std::string& text) {
  if (is_wide(text)) return TextMistake{0, "the deck is no UTF-8, but UTF-16 or UTF-32; save it as UTF-8."};
  if (const std::size_t place = first_unprintable(text); place != std::string::npos) {
    const auto byte = static_cast<unsigned char>(text[place]);
    if (byte < 0x80) return TextMistake{place, fmt::format("here is the control character \\x{:02x}; remove it.", byte)};
    return TextMistake{place, fmt::format("the byte \\x{:02x} here is no UTF-8, or a control character; save the deck as UTF-8.", byte)};
  }
  for (std::size_t at = text.find("&#"); at != std::string::npos; at = text.find("&#", at + 2))
    if (!allowed(referred(text, at + 2)))
      return TextMistake{at, fmt::format("'{}' stands for no character that a text can hold; remove it.",
                                         text.substr(at, std::min<std::size_t>(text.find(';', at) - at + 1, 12)))};
  return std::nullopt;
}

}  // namespace thixis::core
