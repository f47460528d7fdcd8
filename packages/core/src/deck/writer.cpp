#include "deck/writer.hpp"

#include <fmt/core.h>

#include "deck/block_reader.hpp"
#include "thixis/core/uses.hpp"

namespace thixis::core {

namespace {

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\n':
        safe += "&#10;";
        break;
      case '\r':
        safe += "&#13;";
        break;
      case '\t':
        safe += "&#9;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

/// Two hyphens must not stand in a comment.
std::string commented(std::string text) {
  for (auto at = text.find("--"); at != std::string::npos; at = text.find("--")) text.replace(at, 2, "- -");
  return "<!-- " + text + " -->";
}

/// Writes what takes part, block by block.
class DeckWriter {
 public:
  explicit DeckWriter(const Unused& unused) : unused_(unused) {}

  void write_block(const Description& description, const void* object, const std::string& path) {
    for (const auto& parameter : description.parameters())
      if (const auto value = write_value(parameter, object); value && used(joined_path(path, parameter.name)))
        xml.parameter(parameter.name, *value);
    for (const auto& block : description.blocks())
      if (const std::string inside = joined_path(path, block.name); used(inside)) write_sublist(block, object, inside);
  }

  XmlWriter xml;

 private:
  bool used(const std::string& path) const { return unused_.count(path) == 0; }
  void write_sublist(const Description::Block& block, const void* object, const std::string& path);

  const Unused& unused_;
};

void DeckWriter::write_sublist(const Description::Block& block, const void* object, const std::string& path) {
  const auto members = block.members(object);
  if (block.single) {
    if (members.empty()) return;
    xml.open(block.name);
    write_block(*block.inside, members.front().second, path);
    xml.close();
    return;
  }
  if (members.empty()) return;
  xml.open(block.name);
  for (const auto& [name, member] : members) {
    if (block.inside) {
      xml.open(name);
      write_block(*block.inside, member, joined_path(path, name));
      xml.close();
    } else if (const auto value = write_value(*block.value, member)) {
      xml.parameter(name, *value);
    }
  }
  xml.close();
}

}  // namespace

void XmlWriter::open(const std::string& name, const std::string& note) {
  line(fmt::format("<ParameterList name=\"{}\">", escaped(name)), note);
  ++depth_;
}

void XmlWriter::close() {
  --depth_;
  line("</ParameterList>", "");
}

void XmlWriter::parameter(const std::string& name, const Written& value, const std::string& note) {
  line(fmt::format("<Parameter name=\"{}\" type=\"{}\" value=\"{}\"/>", escaped(name), value.type, escaped(value.text)), note);
}

void XmlWriter::line(const std::string& element, const std::string& note) {
  text_.append(2 * depth_, ' ');
  text_ += hidden_ ? commented(note.empty() ? element : element + "  " + note) : note.empty() ? element : element + "  " + commented(note);
  text_ += '\n';
}

std::string to_xml(const Description& root, const void* params) { return to_xml(root, params, Unused{}); }

std::string to_xml(const Description& root, const void* params, const Unused& unused) {
  DeckWriter deck(unused);
  deck.xml.open(root.name());
  deck.write_block(root, params, "");
  deck.xml.close();
  return deck.xml.text();
}

}  // namespace thixis::core
