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

/// A finite number and nothing else but spaces around it; no hex, no inf, no nan. Independent of the locale.
std::optional<double> to_double(const std::string& text);
std::optional<long long> to_integer(const std::string& text);
/// The shortest text that reads back as the same number: 0.1, 1e-8, 3.
std::string to_text(double value);

}  // namespace thixis::core
