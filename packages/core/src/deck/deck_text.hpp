#pragma once
#include <cstddef>
#include <optional>
#include <string>

namespace thixis::core {

/// What makes a text none that is read as XML at all, and where.
struct TextMistake {
  std::size_t place;
  std::string sentence;
};

/// Texts in another encoding than UTF-8, control characters, and references to characters that a text can not hold ("&#0;" would end a
/// value in its middle without a word).
std::optional<TextMistake> text_mistake(const std::string& text);

}  // namespace thixis::core
