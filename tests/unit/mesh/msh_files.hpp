#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
#include <vector>

/// Files in the formats of Gmsh, written for tests.
namespace thixis::mesh {

/// Two unit squares side by side, each cut by its diagonals into the triangles of one surface. Curves: 1 bottom, 2 right, 3 top, 4 left,
/// 5 between the squares. Entities and nodes are numbered from 1.
struct TwoSquares {
  struct Element {
    int entity;
    std::vector<int> nodes;
  };
  std::vector<std::array<double, 2>> points = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}, {0.5, 0.5}, {1.5, 0.5}};
  std::vector<Element> lines = {{1, {1, 2}}, {1, {2, 3}}, {2, {3, 6}}, {3, {6, 5}}, {3, {5, 4}}, {4, {4, 1}}, {5, {2, 5}}};
  std::vector<Element> triangles = {{1, {1, 2, 7}}, {1, {2, 5, 7}}, {1, {5, 4, 7}}, {1, {4, 1, 7}},
                                    {2, {2, 3, 8}}, {2, {3, 6, 8}}, {2, {6, 5, 8}}, {2, {5, 2, 8}}};
  std::map<int, std::vector<int>> curve_groups = {{1, {1}}, {2, {2, 5}}, {3, {5}}, {4, {4, 5}}, {5, {7}}};
  std::map<int, std::vector<int>> surface_groups = {{1, {20, 21}}, {2, {20}}};
  std::map<int, std::string> names = {{1, "bottom side"}, {2, "right"}, {4, "left"}, {5, "rim"}};  ///< of groups of curves
  bool partitioned = false;  ///< surface k is part k, and each part has copies of two cells of the other one
};

enum class Numbers { text, little_endian, big_endian };

/// Writes the numbers of a file in one of the ways there are.
class MshWriter {
 public:
  explicit MshWriter(Numbers numbers) : numbers_(numbers) {}
  bool binary() const { return numbers_ != Numbers::text; }

  MshWriter& text(const std::string& lines) {
    out_ += lines;
    return *this;
  }
  MshWriter& format(const std::string& version) {
    text("$MeshFormat\n" + version + (binary() ? " 1 8\n" : " 0 8\n"));
    if (binary()) integer(1).text("\n");
    return text("$EndMeshFormat\n");
  }
  MshWriter& names(const std::map<int, std::string>& names) {
    text("$PhysicalNames\n" + std::to_string(names.size() + 1) + "\n");
    for (const auto& [group, name] : names) text("1 " + std::to_string(group) + " \"" + name + "\"\n");
    return text("2 20 \"all\"\n$EndPhysicalNames\n");
  }
  MshWriter& integer(std::int64_t value) { return number(static_cast<std::int32_t>(value)); }
  MshWriter& size(std::size_t value) { return number(static_cast<std::uint64_t>(value)); }
  MshWriter& real(double value) { return number(value); }
  template <class Values>
  MshWriter& integers(const Values& values) {
    for (const int value : values) integer(value);
    return *this;
  }
  MshWriter& end_row() { return binary() ? *this : text("\n"); }
  MshWriter& end(const std::string& section) { return text((binary() ? "\n$End" : "$End") + section + "\n"); }
  const std::string& bytes() const { return out_; }

 private:
  template <class T>
  MshWriter& number(T value) {
    if (binary()) {
      char raw[sizeof value];
      std::memcpy(raw, &value, sizeof value);
      if (numbers_ == Numbers::big_endian) std::reverse(raw, raw + sizeof raw);
      out_.append(raw, sizeof raw);
    } else {
      char digits[32];
      std::snprintf(digits, sizeof digits, "%.17g ", static_cast<double>(value));
      out_ += digits;
    }
    return *this;
  }

  Numbers numbers_;
  std::string out_;
};

/// Format 2.2: an element stands there once for each of its groups.
inline std::string msh_22(const TwoSquares& mesh, Numbers numbers) {
  MshWriter out(numbers);
  out.format("2.2").names(mesh.names).text("$Nodes\n" + std::to_string(mesh.points.size()) + "\n");
  for (std::size_t k = 0; k < mesh.points.size(); ++k)
    out.integer(static_cast<int>(k) + 1).real(mesh.points[k][0]).real(mesh.points[k][1]).real(0).end_row();
  MshWriter elements(numbers);
  int count = 0;
  const auto write = [&](int type, const TwoSquares::Element& element, int group) {
    std::vector<int> tags = {group, element.entity};
    if (mesh.partitioned && type == 2) tags.insert(tags.end(), {2, element.entity, element.entity - 3});
    const auto tag_count = static_cast<int>(tags.size());
    if (out.binary()) elements.integer(type).integer(1).integer(tag_count).integer(++count);
    else elements.integer(++count).integer(type).integer(tag_count);
    elements.integers(tags).integers(element.nodes).end_row();
  };
  for (const auto& element : mesh.lines)
    for (const int group : mesh.curve_groups.at(element.entity)) write(1, element, group);
  for (const auto& element : mesh.triangles)
    for (const int group : mesh.surface_groups.at(element.entity)) write(2, element, group);
  out.end("Nodes").text("$Elements\n" + std::to_string(count) + "\n").text(elements.bytes()).end("Elements");
  return out.bytes();
}

/// Format 4.1. The entities of the copies are the surfaces 3 and 4.
inline std::string msh_41(const TwoSquares& mesh, Numbers numbers) {
  MshWriter out(numbers);
  const auto entities = [&](bool partitioned) {
    out.size(0).size(mesh.curve_groups.size()).size(mesh.surface_groups.size()).size(0).end_row();
    for (const auto& all : {mesh.curve_groups, mesh.surface_groups})
      for (const auto& [entity, groups] : all) {
        out.integer(entity);
        if (partitioned) out.integer(2).integer(entity).size(1).integer(entity);
        for (const double bound : {0, 0, 0, 2, 1, 0}) out.real(bound);
        out.size(groups.size()).integers(groups).size(2).integer(1).integer(-2).end_row();
      }
  };
  out.format("4.1").names(mesh.names).text("$Entities\n");
  entities(false);
  out.end("Entities");
  if (mesh.partitioned) {
    out.text("$PartitionedEntities\n").size(2).end_row().size(2).end_row();
    out.integer(3).integer(1).end_row().integer(4).integer(2).end_row();
    entities(true);
    out.end("PartitionedEntities");
  }
  const std::size_t copies = mesh.partitioned ? 2 : 0, nodes = mesh.points.size();
  out.text("$Nodes\n").size(1 + copies).size(nodes + copies).size(1).size(nodes).end_row();
  out.integer(2).integer(1).integer(0).size(nodes).end_row();
  for (std::size_t k = 0; k < nodes; ++k) out.size(k + 1).end_row();
  for (const auto& point : mesh.points) out.real(point[0]).real(point[1]).real(0).end_row();
  for (std::size_t part = 0; part < copies; ++part)
    out.integer(2).integer(static_cast<int>(part) + 3).integer(0).size(1).end_row().size(2).end_row().real(1).real(0).real(0).end_row();
  out.end("Nodes");

  const auto& [lines, triangles] = std::tie(mesh.lines, mesh.triangles);
  const std::size_t count = lines.size() + triangles.size();
  out.text("$Elements\n").size(lines.size() + 2 + copies).size(count + 2 * copies).size(1).size(count).end_row();
  for (std::size_t k = 0; k < lines.size(); ++k)
    out.integer(1)
        .integer(lines[k].entity)
        .integer(1)
        .size(1)
        .end_row()
        .size(k + 1)
        .size(lines[k].nodes[0])
        .size(lines[k].nodes[1])
        .end_row();
  const auto block = [&](int surface, std::size_t first, std::size_t last) {
    out.integer(2).integer(surface).integer(2).size(last - first).end_row();
    for (std::size_t k = first; k < last; ++k) {
      out.size(lines.size() + k + 1);
      for (const int node : triangles[k].nodes) out.size(node);
      out.end_row();
    }
  };
  block(1, 0, 4);
  block(2, 4, 8);
  if (mesh.partitioned) block(3, 4, 6), block(4, 1, 3);
  out.end("Elements");
  return out.bytes();
}

}  // namespace thixis::mesh
