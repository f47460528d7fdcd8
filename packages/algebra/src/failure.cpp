#include "failure.hpp"

#include <cctype>

#include "method.hpp"

namespace thixis::algebra {
namespace {

/// Runs of blanks and line ends as one blank.
std::string in_one_line(const std::string& text) {
  std::string line;
  for (const unsigned char c : text) {
    const bool blank = std::isspace(c) != 0 || std::iscntrl(c) != 0;
    if (blank && (line.empty() || line.back() == ' ')) continue;
    line += blank ? ' ' : static_cast<char>(c);
  }
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

}  // namespace

std::string said_by(const std::exception& exception) {
  constexpr std::size_t longest = 200;
  std::string text = exception.what();
  const std::string before = "Throw test that evaluated to true:";  // Teuchos: file, condition, a blank line, the sentence
  if (const auto test = text.find(before); test != std::string::npos)
    if (const auto end = text.find("\n\n", test); end != std::string::npos) text = text.substr(end);
  text = in_one_line(text);
  if (text.size() > longest) text = text.substr(0, longest) + " ...";
  return text.empty() ? "no reason is given" : text;
}

void break_down_together(const core::Comm& comm, const std::string& failure, const std::optional<std::string>& said) {
  const int first = comm.min(said ? comm.rank() : comm.size());
  if (first == comm.size()) return;
  const std::string mine = comm.rank() == first ? *said : "";
  const auto text = comm.gather(std::vector<char>(mine.begin(), mine.end()));
  throw Breakdown(failure + ": " + std::string(text.begin(), text.end()));
}

}  // namespace thixis::algebra
