#include <gmsh.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <unordered_map>

#include "thixis/core/error.hpp"
#include "triangulation.hpp"

namespace thixis::mesh {
namespace {

using core::FileError;
using core::InputError;

constexpr int line = 1, triangle = 2;  // element types of Gmsh with straight sides

/// Gmsh between initialize and finalize, silent, not reading the user's settings, and not stopped by floating-point traps.
class Session {
 public:
  Session() {
    std::feholdexcept(&environment_);
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.Verbosity", 0);
  }
  ~Session() {
    gmsh::finalize();
    std::fesetenv(&environment_);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  std::fenv_t environment_;
};

/// Looks for the version before Gmsh sees the file: it would take any other format, and scripts, too.
void require_format(const std::string& path, const std::string& name) {
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (std::filesystem::is_directory(path, ignored))
    throw FileError(name + " is a folder; write the name of a Gmsh mesh relative to the deck.");
  if (!file || !std::filesystem::is_regular_file(path, ignored))
    throw FileError(name + " can not be opened; write the name of a Gmsh mesh relative to the deck.");
  std::string head(1 << 16, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));

  const std::string section = "$MeshFormat";
  const auto start = head.find(section);
  const std::string how = "; save it as Gmsh mesh in format 4.1 or 2.2 (gmsh -save -format msh41).";
  if (start == std::string::npos) throw InputError(name + " is not a Gmsh mesh" + how);
  const auto first = head.find_first_not_of(" \t\r\n", start + section.size());
  const std::string version = first == std::string::npos ? "" : head.substr(first, head.find_first_of(" \t\r\n", first) - first);
  if (version != "2.2" && version != "4.1") throw InputError(name + " has format " + version + how);
}

/// Elements of one type and dimension: `type` of Gmsh, or the error.
std::vector<std::size_t> nodes_of(int dimension, int entity, int type, const std::string& name) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> elements, nodes;
  gmsh::model::mesh::getElements(types, elements, nodes, dimension, entity);
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < types.size(); ++k) {
    if (types[k] != type) {
      std::string kind;
      int dim, order, count, corners;
      std::vector<double> coordinates;
      gmsh::model::mesh::getElementProperties(types[k], kind, dim, order, count, coordinates, corners);
      throw InputError(name + " has elements of the kind '" + kind +
                       "'; give a plane mesh of straight triangles (in Gmsh: element order 1, no recombination).");
    }
    found.insert(found.end(), nodes[k].begin(), nodes[k].end());
  }
  return found;
}

/// The vertices of the triangles, numbered in the order of their node tags.
class Vertices {
 public:
  Vertices(std::vector<std::size_t> used, const std::string& name) : name_(name) {
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    number_.reserve(used.size());
    for (const std::size_t tag : used) number_.emplace(tag, static_cast<LocalIndex>(number_.size()));
  }

  LocalIndex operator()(std::size_t tag) const {
    const auto found = number_.find(tag);
    if (found == number_.end()) throw InputError(name_ + " has edges in physical groups that are no side of a triangle; remove them.");
    return found->second;
  }

  std::vector<std::array<double, 2>> points() const {
    std::vector<std::size_t> tags;
    std::vector<double> x, unused;
    gmsh::model::mesh::getNodes(tags, x, unused, -1, -1, false, false);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::array<double, 2>> points(number_.size(), {nan, nan});
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest, extent = 0;
    for (std::size_t k = 0; k < tags.size(); ++k) {
      const auto found = number_.find(tags[k]);
      if (found == number_.end()) continue;
      points[found->second] = {x[3 * k], x[3 * k + 1]};
      lowest = std::min(lowest, x[3 * k + 2]);
      highest = std::max(highest, x[3 * k + 2]);
      extent = std::max({extent, std::abs(x[3 * k] - points[0][0]), std::abs(x[3 * k + 1] - points[0][1])});
    }
    for (const auto& point : points)
      if (!std::isfinite(point[0]) || !std::isfinite(point[1]))
        throw InputError(name_ + " lacks a node of some triangle, or its coordinates; write it anew.");
    if (!(highest - lowest <= 1e-10 * extent)) throw InputError(name_ + " is not plane; give a mesh of which all nodes have the same z.");
    return points;
  }

 private:
  std::string name_;
  std::unordered_map<std::size_t, LocalIndex> number_;
};

std::vector<std::array<LocalIndex, 3>> oriented_cells(const std::vector<std::size_t>& nodes, const Vertices& vertices,
                                                      const std::vector<std::array<double, 2>>& points) {
  std::vector<std::array<LocalIndex, 3>> cells(nodes.size() / 3);
  for (std::size_t K = 0; K < cells.size(); ++K) {
    auto& [a, b, c] = cells[K];
    a = vertices(nodes[3 * K]), b = vertices(nodes[3 * K + 1]), c = vertices(nodes[3 * K + 2]);
    const auto &x = points[a], &y = points[b], &z = points[c];
    if ((y[0] - x[0]) * (z[1] - x[1]) < (z[0] - x[0]) * (y[1] - x[1])) std::swap(b, c);
  }
  return cells;
}

void add_groups(const Vertices& vertices, Triangulation& mesh) {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, 1);
  for (const auto& [dimension, group] : groups) {
    std::string tag;
    gmsh::model::getPhysicalName(dimension, group, tag);
    if (tag.empty()) tag = "physical " + std::to_string(group);
    const auto known = std::find(mesh.tags.begin(), mesh.tags.end(), tag);
    const auto index = static_cast<int>(known - mesh.tags.begin());
    if (known == mesh.tags.end()) mesh.tags.push_back(tag);

    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, group, entities);
    for (const int entity : entities) {
      const std::vector<std::size_t> nodes = nodes_of(dimension, entity, line, mesh.name);
      for (std::size_t k = 0; k + 1 < nodes.size(); k += 2) mesh.boundary.push_back({vertices(nodes[k]), vertices(nodes[k + 1]), index});
    }
  }
}

Triangulation current_model(const std::string& name) {
  Triangulation mesh;
  mesh.name = name;
  nodes_of(3, -1, 0, name);  // none is allowed
  const std::vector<std::size_t> nodes = nodes_of(2, -1, triangle, name);
  if (nodes.empty())
    throw InputError(name + " has no triangles; give a mesh of a plane domain (gmsh -2, with its surfaces in a physical group or none).");
  const Vertices vertices(nodes, name);
  mesh.points = vertices.points();
  mesh.cells = oriented_cells(nodes, vertices, mesh.points);
  add_groups(vertices, mesh);
  return mesh;
}

}  // namespace

Triangulation read_gmsh(const std::string& path) {
  const std::string name = "mesh/file: '" + path + "'";
  require_format(path, name);
  const Session session;
  std::string reason;
  try {
    gmsh::merge(path);  // unlike open, it reads no options beside the file
    return current_model(name);
  } catch (const core::Error&) {
    throw;
  } catch (const std::string& message) {  // what the API of Gmsh throws
    reason = message;
  } catch (const std::exception& error) {
    reason = error.what();
  } catch (int) {
    reason = "unknown reason";
  }
  throw InputError(name + " is damaged (" + reason + "); write it anew.");
}

}  // namespace thixis::mesh
