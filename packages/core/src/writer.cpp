#include "writer.hpp"

#include <fmt/core.h>

#include "thixis/core/schema.hpp"

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

void write_block(XmlWriter& xml, const Description& description, const void* object);

void write_sublist(XmlWriter& xml, const Description::Block& block, const void* object) {
  const auto members = block.members(object);
  if (block.single) {
    if (members.empty()) return;
    xml.open(block.name);
    write_block(xml, *block.inside, members.front().second);
    xml.close();
    return;
  }
  if (members.empty()) return;
  xml.open(block.name);
  for (const auto& [name, member] : members) {
    if (block.inside) {
      xml.open(name);
      write_block(xml, *block.inside, member);
      xml.close();
    } else if (const auto value = write_value(*block.value, member)) {
      xml.parameter(name, *value);
    }
  }
  xml.close();
}

void write_block(XmlWriter& xml, const Description& description, const void* object) {
  for (const auto& parameter : description.parameters())
    if (const auto value = write_value(parameter, object)) xml.parameter(parameter.name, *value);
  for (const auto& block : description.blocks()) write_sublist(xml, block, object);
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

std::string to_xml(const Description& root, const void* params) {
  XmlWriter xml;
  xml.open(root.name());
  write_block(xml, root, params);
  xml.close();
  return xml.text();
}

}  // namespace thixis::core
