#pragma once
#include <optional>
#include <string>
#include <vector>

namespace thixis::core {

/// The candidate nearest to `name` by edit distance without regard to case, if it is near: at most max(2, length/3) edits. Among
/// equally near ones the one with the longest common beginning.
std::optional<std::string> nearest(const std::string& name, const std::vector<std::string>& candidates);
/// "Did you mean 'degree'?", or if nothing is near "<otherwise> a, b, c."
std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates, const std::string& otherwise = "Valid here:");
std::string join(const std::vector<std::string>& words, const std::string& separator = ", ");

/// A text that a terminal shows as it is, for words of others: control characters (terminal escapes), those that turn the direction of
/// writing, and bytes that are not UTF-8 become \x1b, \u202e, \xff. Ends of lines and tabs stay.
std::string printable(const std::string& text);
/// The same on one line: ends of lines and tabs become \x0a, \x09, too.
std::string one_line(const std::string& text);
/// The place of the first control character but tab, line feed and carriage return, or of the first byte that is not UTF-8; npos: none.
std::size_t first_unprintable(const std::string& text);
/// The text, or its beginning and end with "..." between them where it has more than `most` bytes.
std::string shortened(const std::string& text, std::size_t most);

/// A finite number and nothing else but spaces around it; no hex, no inf, no nan. Independent of the locale.
std::optional<double> to_double(const std::string& text);
std::optional<long long> to_integer(const std::string& text);
/// The shortest text that reads back as the same number: 0.1, 1e-8, 3.
std::string to_text(double value);

}  // namespace thixis::core
