#include "deck/xml_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <pugixml.hpp>

#include "deck/deck_text.hpp"
#include "deck/limits.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {

namespace {

constexpr const char* how_a_parameter_looks = "<Parameter name=\"...\" type=\"...\" value=\"...\"/>";

class Lines {
 public:
  explicit Lines(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') ends_.push_back(i);
  }
  int of(std::ptrdiff_t offset) const {
    const auto place = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
    return 1 + static_cast<int>(std::lower_bound(ends_.begin(), ends_.end(), place) - ends_.begin());
  }

 private:
  std::vector<std::size_t> ends_;
};

class XmlReader {
 public:
  XmlReader(const Lines& lines, const std::string& file, std::vector<Deck::Mistake>& mistakes)
      : lines_(lines), file_(file), mistakes_(mistakes) {}

  /// Throws InputError where the deck is too large to be read on.
  Deck::Entry list(const pugi::xml_node& node, const std::string& path, int depth = 1) {
    if (depth > limits::nested_lists)
      fail(node, fmt::format("the lists are nested too deep; no block of a deck lies in more than {} others.", limits::nested_lists - 1));
    Deck::Entry entry;
    entry.list = true;
    entry.line = line(node);
    entry.name = node.attribute("name").value();
    check_attributes(node, path, {"name", "id"});
    std::map<std::string, int> first;
    for (const auto& child : node.children()) {
      if (++read_ > limits::entries) fail(child, fmt::format("the deck is too long; it may have {} entries.", limits::entries));
      auto member = read_member(child, path, depth);
      if (!member) continue;
      const auto [known, added] = first.emplace(member->name, member->line);
      if (!added) report(child, joined(path, member->name), fmt::format("already given on line {}; remove one of the two.", known->second));
      else entry.inside.push_back(std::move(*member));
    }
    return entry;
  }

  int line(const pugi::xml_node& node) const { return lines_.of(node.offset_debug()); }
  void report(const pugi::xml_node& node, const std::string& path, const std::string& sentence) {
    mistakes_.push_back({line(node), -1, path, sentence});
  }

 private:
  static std::string joined(const std::string& path, const std::string& name) { return path.empty() ? name : path + "/" + name; }

  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& sentence) const {
    throw InputError(fmt::format("{}:{}: {}", one_line(file_), line(node), sentence));
  }

  std::optional<Deck::Entry> read_member(const pugi::xml_node& node, const std::string& path, int depth) {
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
      const std::string text = node.value();
      const auto begin = text.begin(), word = begin + static_cast<std::ptrdiff_t>(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
      const std::string shown(word,
                              std::find_if(word, text.end(), [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }));
      mistakes_.push_back({line(node) + static_cast<int>(std::count(begin, word, '\n')), -1, path,
                           fmt::format("'{}' stands between the tags; write values as {}.", shown, how_a_parameter_looks)});
      return std::nullopt;
    }
    const std::string element = node.name();
    const std::string name = node.attribute("name").value();
    if (element != "Parameter" && element != "ParameterList") {
      report(node, path,
             fmt::format("no such element <{}>. {}", element, did_you_mean(element, {"Parameter", "ParameterList"}, "Write one of")));
      return std::nullopt;
    }
    if (name.empty()) {
      report(node, path,
             fmt::format("a <{}> has no name; write {}.", element,
                         element == "Parameter" ? how_a_parameter_looks : "<ParameterList name=\"...\">"));
      return std::nullopt;
    }
    if (name.size() > limits::name_bytes) {
      report(node, path, fmt::format("a name of {} letters is too long; write at most {}.", name.size(), limits::name_bytes));
      return std::nullopt;
    }
    if (hidden(node, path, name)) return std::nullopt;
    return element == "ParameterList" ? list(node, joined(path, name), depth + 1) : parameter(node, joined(path, name));
  }

  /// Ends of lines in an attribute are spaces; what is still one here was written as a reference.
  bool hidden(const pugi::xml_node& node, const std::string& path, const std::string& text) {
    const auto found = std::find_if(text.begin(), text.end(), [](unsigned char c) { return c < 0x20; });
    if (found == text.end()) return false;
    report(node, path, fmt::format("'{}' holds the character &#{};, which is none to write; remove it.", text, static_cast<int>(*found)));
    return true;
  }

  Deck::Entry parameter(const pugi::xml_node& node, const std::string& path) {
    Deck::Entry entry;
    entry.line = line(node);
    entry.name = node.attribute("name").value();
    entry.type = node.attribute("type").value();
    entry.value = node.attribute("value").value();
    check_attributes(node, path, {"name", "type", "value", "id", "docString", "isDefault", "isUsed"});
    for (const char* attribute : {"type", "value"})
      if (!node.attribute(attribute))
        report(node, path, fmt::format("the attribute '{}' is missing; write {}.", attribute, how_a_parameter_looks));
    entry.complete = node.attribute("type") && node.attribute("value") && !hidden(node, path, entry.value);
    if (node.first_child())
      report(node, path, fmt::format("a <Parameter> holds nothing between its tags; write {}.", how_a_parameter_looks));
    return entry;
  }

  /// Those that Teuchos itself writes (id, docString, ...) are allowed and mean nothing here.
  void check_attributes(const pugi::xml_node& node, const std::string& path, const std::vector<std::string>& known) {
    std::map<std::string, int> count;
    for (const auto& attribute : node.attributes()) {
      const std::string name = attribute.name();
      if (std::find(known.begin(), known.end(), name) == known.end())
        report(node, path, fmt::format("no such attribute '{}'. {}", name, did_you_mean(name, known)));
      else if (++count[name] == 2) report(node, path, fmt::format("the attribute '{}' stands there twice; remove one of the two.", name));
    }
  }

  const Lines& lines_;
  const std::string& file_;
  std::vector<Deck::Mistake>& mistakes_;
  int read_ = 0;  ///< elements, texts and comments so far
};

}  // namespace

Deck::Entry read_xml(const std::string& text, const std::string& file, std::vector<Deck::Mistake>& mistakes) {
  constexpr const char* frame = "<ParameterList name=\"...\"> ... </ParameterList>";
  const Lines lines(text);
  const auto fail = [&](int line, const std::string& sentence) -> InputError {
    return InputError(fmt::format("{}:{}: {}", one_line(file), line, sentence));
  };
  if (text.size() > limits::deck_bytes)
    throw fail(1, fmt::format("the deck is larger than {} MB; decks are small, and meshes stand in files of their own (mesh/file).",
                              limits::deck_bytes >> 20u));
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw fail(1, fmt::format("the deck is empty; write {}.", frame));
  if (const auto mistake = text_mistake(text)) throw fail(lines.of(static_cast<std::ptrdiff_t>(mistake->place)), mistake->sentence);
  pugi::xml_document document;
  const auto result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_fragment | pugi::parse_doctype, pugi::encoding_utf8);
  if (!result) {
    std::string reason = result.description();
    if (!reason.empty()) reason[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(reason[0])));
    throw fail(lines.of(result.offset), fmt::format("this is no XML, here or just before: {}.", reason));
  }
  XmlReader reader(lines, file, mistakes);
  pugi::xml_node root;
  for (const auto& node : document.children()) {
    if (node.type() == pugi::node_pcdata)
      throw fail(reader.line(node), fmt::format("there is text outside of the outermost list; write {}.", frame));
    if (node.type() == pugi::node_doctype)
      throw fail(reader.line(node), "a deck has no document type, and no entities of its own; remove <!DOCTYPE ...>.");
    if (node.type() != pugi::node_element) continue;
    if (root) throw fail(reader.line(node), "a second outermost element begins here; put everything into one <ParameterList>.");
    root = node;
  }
  if (!root) throw fail(1, fmt::format("the deck holds no list; write {}.", frame));
  if (std::string(root.name()) != "ParameterList")
    throw fail(reader.line(root), fmt::format("the outermost element is <{}>; write {}.", root.name(), frame));
  return reader.list(root, "");
}

}  // namespace thixis::core
