#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <tuple>

#include "gmsh/msh_content.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/file.hpp"
#include "triangulation.hpp"

namespace thixis::mesh {
namespace {

using core::FileError;
using core::InputError;

void require_open(core::RegularFile::State state, const std::string& name) {
  using State = core::RegularFile::State;
  if (state == State::open) return;
  throw FileError(name +
                  (state == State::folder    ? " is a folder"
                   : state == State::special ? " is no regular file, but a pipe or a device"
                                             : " can not be opened") +
                  "; write the name of a Gmsh mesh relative to the deck.");
}

std::string bytes_of(const std::string& path, const std::string& name) {
  core::RegularFile file(path);
  require_open(file.state(), name);
  if (file.size() > std::size_t{16} << 30)
    throw FileError(name + " is larger than 16 GB; the coarsest mesh is held by every rank: give a coarser one and more refinements.");
  std::string bytes(file.size(), '\0');
  if (file.read(bytes.data(), bytes.size()) < bytes.size()) throw FileError(name + " can not be read to its end; copy it anew.");
  return bytes;
}

void require_all_parts(const MshContent& content, const std::string& name) {
  const auto count = std::distance(content.parts.lower_bound(1), content.parts.end());
  if (count >= content.count_of_parts) return;
  throw InputError(name + " holds " + std::to_string(count) + " of the " + std::to_string(content.count_of_parts) +
                   " parts of a partitioned mesh; give the whole mesh in one file (in Gmsh: Mesh.PartitionSplitMeshFiles = 0).");
}

void require_different_elements(std::vector<std::int64_t> numbers, const std::string& name) {
  if (!std::is_sorted(numbers.begin(), numbers.end())) std::sort(numbers.begin(), numbers.end());
  const auto twice = std::adjacent_find(numbers.begin(), numbers.end());
  if (twice != numbers.end())
    throw InputError(name + " has two elements with the number " + std::to_string(*twice) + "; number them differently, or save it anew.");
}

/// Format 2.2 writes a triangle once for each physical group of its surface: keeps the first.
void drop_copies(std::vector<MshContent::Triangle>& triangles) {
  const auto of_one_group = [&](const MshContent::Triangle& triangle) { return triangle.group == triangles.front().group; };
  if (std::all_of(triangles.begin(), triangles.end(), of_one_group)) return;

  using Key = std::tuple<std::array<std::int64_t, 3>, int, std::size_t>;  // nodes, surface, position
  std::vector<Key> keys;
  keys.reserve(triangles.size());
  for (const auto& triangle : triangles) {
    keys.emplace_back(triangle.nodes, triangle.surface, keys.size());
    auto& nodes = std::get<0>(keys.back());
    std::sort(nodes.begin(), nodes.end());
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> copy(triangles.size(), false);
  for (std::size_t k = 1, first = 0; k < keys.size(); ++k) {
    const auto& [nodes, surface, position] = keys[k];
    if (nodes != std::get<0>(keys[first]) || surface != std::get<1>(keys[first])) first = k;
    else copy[position] = triangles[position].group != triangles[std::get<2>(keys[k - 1])].group;
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < triangles.size(); ++k)
    if (!copy[k]) triangles[kept++] = triangles[k];
  triangles.resize(kept);
}

/// The nodes of the file in the order of their numbers, and the vertices: those that a triangle has, in the same order.
class Vertices {
 public:
  Vertices(std::vector<MshContent::Node> nodes, const std::vector<MshContent::Triangle>& triangles, const std::string& name)
      : nodes_(std::move(nodes)), vertex_(nodes_.size(), -1), name_(name) {
    const auto before = [](const auto& a, const auto& b) { return a.number < b.number; };
    if (!std::is_sorted(nodes_.begin(), nodes_.end(), before)) std::sort(nodes_.begin(), nodes_.end(), before);
    const auto same = [](const auto& a, const auto& b) { return a.number == b.number; };
    const auto twice = std::adjacent_find(nodes_.begin(), nodes_.end(), same);
    if (twice != nodes_.end())
      throw InputError(name + " has two nodes with the number " + std::to_string(twice->number) +
                       "; number them differently, or save it anew.");
    for (const auto& triangle : triangles)
      for (const std::int64_t node : triangle.nodes) vertex_[position("triangle", triangle.number, node)] = 0;
    for (LocalIndex& vertex : vertex_)
      if (vertex == 0) vertex = count_++;
  }

  LocalIndex of_triangle(const MshContent::Triangle& triangle, int i) const {
    return vertex_[position("triangle", triangle.number, triangle.nodes[i])];
  }
  LocalIndex of_line(const MshContent::Line& line, int i) const {
    const LocalIndex vertex = vertex_[position("edge", line.number, line.nodes[i])];
    if (vertex < 0) throw InputError(name_ + " has edges in physical groups that are no side of a triangle; remove them.");
    return vertex;
  }

  std::vector<std::array<double, 2>> points() const {
    const double inf = std::numeric_limits<double>::infinity();
    std::array<double, 3> low = {inf, inf, inf}, high = {-inf, -inf, -inf};
    std::vector<std::array<double, 2>> points;
    points.reserve(count_);
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      if (vertex_[k] < 0) continue;
      const auto& x = nodes_[k].x;
      points.push_back({x[0], x[1]});
      for (int d = 0; d < 3; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
    }
    if (!(high[2] - low[2] <= 1e-10 * std::max(high[0] - low[0], high[1] - low[1])))
      throw InputError(name_ + " is not plane; give a mesh of which all nodes have the same z.");
    return points;
  }

 private:
  std::size_t position(const char* kind, std::int64_t element, std::int64_t number) const {
    const auto before = [](const MshContent::Node& node, std::int64_t wanted) { return node.number < wanted; };
    // Where no number is left out there is nothing to look for.
    const std::int64_t guess = nodes_.empty() ? 0 : number - nodes_.front().number;
    if (guess >= 0 && guess < static_cast<std::int64_t>(nodes_.size()) && nodes_[guess].number == number) return guess;
    const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), number, before);
    if (found == nodes_.end() || found->number != number)
      throw InputError(name_ + ": the " + kind + " " + std::to_string(element) + " has the node " + std::to_string(number) +
                       ", which is not in the file; correct it, or save the mesh anew.");
    return found - nodes_.begin();
  }

  std::vector<MshContent::Node> nodes_;
  std::vector<LocalIndex> vertex_;
  LocalIndex count_ = 0;
  std::string name_;
};

std::vector<std::array<LocalIndex, 3>> oriented_cells(const std::vector<MshContent::Triangle>& triangles, const Vertices& vertices,
                                                      const std::vector<std::array<double, 2>>& points) {
  std::vector<std::array<LocalIndex, 3>> cells;
  cells.reserve(triangles.size());
  for (const auto& triangle : triangles) {
    std::array<LocalIndex, 3> cell;
    for (int i = 0; i < 3; ++i) cell[i] = vertices.of_triangle(triangle, i);
    const auto &x = points[cell[0]], &y = points[cell[1]], &z = points[cell[2]];
    if ((y[0] - x[0]) * (z[1] - x[1]) < (z[0] - x[0]) * (y[1] - x[1])) std::swap(cell[1], cell[2]);
    cells.push_back(cell);
  }
  return cells;
}

void add_boundary(MshContent& content, const Vertices& vertices, Triangulation& mesh) {
  std::stable_sort(content.lines.begin(), content.lines.end(), [](const auto& a, const auto& b) { return a.group < b.group; });
  const MshContent::Line* before = nullptr;
  int tag = 0;
  for (const auto& line : content.lines) {
    if (!before || before->group != line.group) {
      const auto named = content.names.find(line.group);
      const bool unnamed = named == content.names.end() || named->second.empty();
      const std::string name = unnamed ? "physical " + std::to_string(line.group) : named->second;
      const auto known = std::find(mesh.tags.begin(), mesh.tags.end(), name);
      tag = static_cast<int>(known - mesh.tags.begin());
      if (known == mesh.tags.end()) mesh.tags.push_back(name);
    }
    before = &line;
    mesh.boundary.push_back({vertices.of_line(line, 0), vertices.of_line(line, 1), tag});
  }
}

}  // namespace

Triangulation gmsh_triangulation(std::string bytes, const std::string& name) {
  MshContent content = read_msh(std::move(bytes), name);
  if (content.triangles.empty())
    throw InputError(name + " has no triangles; give a mesh of a plane domain (gmsh -2, with its surfaces in a physical group or none).");
  require_all_parts(content, name);
  require_different_elements(std::move(content.elements), name);
  drop_copies(content.triangles);
  std::stable_sort(content.triangles.begin(), content.triangles.end(), [](const auto& a, const auto& b) { return a.surface < b.surface; });

  Triangulation mesh;
  mesh.name = name;
  const Vertices vertices(std::move(content.nodes), content.triangles, name);
  mesh.points = vertices.points();
  mesh.cells = oriented_cells(content.triangles, vertices, mesh.points);
  add_boundary(content, vertices, mesh);
  return mesh;
}

Triangulation read_gmsh(const std::string& path) {
  const std::string name = "mesh/file: '" + path + "'";
  try {
    return gmsh_triangulation(bytes_of(path, name), name);
  } catch (const std::bad_alloc&) {
    throw FileError(name + " needs more memory than there is; give a coarser mesh and more refinements.");
  }
}

}  // namespace thixis::mesh
