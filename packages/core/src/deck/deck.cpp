#include "thixis/core/deck.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "deck/block_reader.hpp"
#include "deck/limits.hpp"
#include "deck/xml_reader.hpp"
#include "thixis/core/file.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {

namespace {

std::string text_of_file(const std::string& path) {
  const auto refused = [&](const char* sentence) { return FileError(fmt::format("{}: {}", one_line(path), sentence)); };
  RegularFile file(path);
  switch (file.state()) {
    case RegularFile::State::folder:
      throw refused("this is a folder; give the deck, an XML file.");
    case RegularFile::State::absent:
      throw refused("there is no such file; give the path of a deck.");
    case RegularFile::State::special:
      throw refused("this is no regular file, but a pipe or a device; write the deck to a file, and give its path.");
    case RegularFile::State::unreadable:
      throw refused("the file can not be read; check its permissions.");
    case RegularFile::State::open:
      break;
  }
  return file.read_up_to(limits::deck_bytes);
}

/// What is wrong with the words of a --set, or nothing.
std::string mistake_of(const std::string& assignment, const std::vector<std::string>& names) {
  const auto empty = [](const std::string& name) { return name.empty(); };
  const auto too_long = [](const std::string& name) { return name.size() > limits::name_bytes; };
  const auto unprintable = [](unsigned char c) { return c < 0x20; };
  if (assignment.find('=') == std::string::npos || std::any_of(names.begin(), names.end(), empty))
    return "this is no assignment; write path=value, e.g. --set method/degree=3.";
  if (first_unprintable(assignment) != std::string::npos || std::any_of(assignment.begin(), assignment.end(), unprintable))
    return "here is a control character, or a byte that is no UTF-8; remove it.";
  if (names.size() > limits::nested_lists || std::any_of(names.begin(), names.end(), too_long))
    return "no parameter of a deck has such a long path; write e.g. --set method/degree=3.";
  return "";
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> names;
  std::istringstream stream(path);
  for (std::string name; std::getline(stream, name, '/');) names.push_back(name);
  if (path.empty() || path.back() == '/') names.emplace_back();
  return names;
}

}  // namespace

const Deck::Entry* Deck::Entry::find(const std::string& member, bool is_list) const {
  const auto found = std::find_if(inside.begin(), inside.end(), [&](const Entry& e) { return e.list == is_list && e.name == member; });
  return found == inside.end() ? nullptr : &*found;
}

const Deck::Entry& Deck::Entry::along(const std::string& path, bool& exact) const {
  const Entry* place = this;
  exact = true;
  if (path.empty()) return *place;
  const auto names = split_path(path);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Entry* next = place->find(names[i], true);
    if (next == nullptr && i + 1 == names.size()) next = place->find(names[i], false);
    exact = next != nullptr;
    if (!exact) break;
    place = next;
  }
  return *place;
}

Deck Deck::read(const std::string& path, const Comm& comm) {
  return from_text(comm.on_root([&] { return text_of_file(path); }), path);
}

Deck Deck::from_text(const std::string& text, const std::string& name, const std::string& folder) {
  Deck deck;
  deck.file_ = name;
  deck.folder_ = folder;
  deck.root_ = read_xml(text, name, deck.mistakes_);
  return deck;
}

void Deck::set(const std::string& assignment) {
  const auto equals = assignment.find('=');
  const auto names = split_path(assignment.substr(0, equals));
  if (const std::string mistake = mistake_of(assignment, names); !mistake.empty())
    throw InputError(fmt::format("--set {}: {}", one_line(shortened(assignment, limits::shown_bytes)), mistake));
  if (assignments_.size() == limits::assignments)
    throw InputError(fmt::format("--set: there are more than {} of them; write a deck.", limits::assignments));

  const int number = static_cast<int>(assignments_.size());
  assignments_.push_back(assignment);
  Entry* place = &root_;
  const auto member = [&](const std::string& name, bool list) -> Entry& {
    const auto found =
        std::find_if(place->inside.begin(), place->inside.end(), [&](const Entry& e) { return e.list == list && e.name == name; });
    if (found != place->inside.end()) return *found;
    Entry entry;
    entry.name = name;
    entry.list = list;
    entry.assignment = number;
    return place->inside.emplace_back(entry);
  };
  for (std::size_t i = 0; i + 1 < names.size(); ++i) place = &member(names[i], true);
  Entry& parameter = member(names.back(), false);
  parameter.type.clear();
  parameter.value = assignment.substr(equals + 1);
  parameter.complete = true;
  parameter.assignment = number;
}

void Deck::fill(const Description& description, void* params) const {
  BlockReader reader(description, mistakes_);
  if (root_.name != description.name())
    reader.add(root_, "",
               root_.name.empty()
                   ? fmt::format("the outermost list has no name; write <ParameterList name=\"{}\">.", description.name())
                   : fmt::format("the outermost list is called '{}'; write <ParameterList name=\"{}\">.", root_.name, description.name()));
  reader.read(description, params, &root_, root_, "");
  auto mistakes = std::move(reader).mistakes();
  if (mistakes.empty()) return;
  std::stable_sort(mistakes.begin(), mistakes.end(), [](const Mistake& a, const Mistake& b) {
    return a.assignment != b.assignment ? a.assignment < b.assignment : a.assignment < 0 && a.line < b.line;
  });
  std::vector<std::string> lines;
  for (const auto& mistake : mistakes) {
    if (lines.size() == limits::shown_mistakes) break;
    lines.push_back(message(mistake));
  }
  if (mistakes.size() > lines.size()) lines.push_back(fmt::format("... and {} more mistakes.", mistakes.size() - lines.size()));
  throw InputError(join(lines, "\n"));
}

std::string Deck::message(const Mistake& mistake) const {
  const std::string place =
      mistake.assignment < 0 ? fmt::format("{}:{}", file_, mistake.line) : fmt::format("--set {}", assignments_[mistake.assignment]);
  const std::string& path = mistake.path.empty() ? root_.name : mistake.path;
  const std::string line =
      fmt::format("{}: {}{}{}", shortened(place, limits::shown_bytes), path, path.empty() ? "" : ": ", mistake.sentence);
  return one_line(shortened(line, 2 * limits::shown_bytes));
}

InputError Deck::error(const std::string& path, const std::string& sentence) const {
  bool exact = false;
  const Entry& place = root_.along(path, exact);
  return InputError(message({place.line, place.assignment, path, sentence}));
}

Error Deck::located(const Error& error) const {
  std::istringstream stream(error.what());
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    const auto colon = line.find(": ");
    const std::string path = line.substr(0, colon);
    const bool of_the_deck = colon != std::string::npos && root_.find(path.substr(0, path.find('/')), true) != nullptr;
    lines.push_back(of_the_deck ? this->error(path, line.substr(colon + 2)).what() : line);
  }
  return {error.code(), join(lines, "\n")};
}

bool Deck::given(const std::string& path) const {
  bool exact = false;
  root_.along(path, exact);
  return exact;
}

std::string Deck::folder() const {
  const std::string folder = !folder_.empty() ? folder_ : std::filesystem::path(file_).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::string Deck::stem() const { return std::filesystem::path(file_).stem().string(); }

}  // namespace thixis::core
