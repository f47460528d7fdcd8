#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>

#include "lengths.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/groups.hpp"
#include "thixis/mesh/host.hpp"
#include "triangulation.hpp"

namespace thixis::mesh {
namespace {

/// One side of a cell.
struct Side {
  LocalIndex low, high;  ///< end vertices
  LocalIndex cell;
  int i;     ///< opposite vertex
  int slot;  ///< in face_cells: 0 if the cell has it from low to high

  bool same_face(const Side& other) const { return low == other.low && high == other.high; }
  bool operator<(const Side& other) const {
    return low != other.low ? low < other.low : high != other.high ? high < other.high : slot < other.slot;
  }
};

std::vector<Side> sorted_sides(const Triangulation& triangulation) {
  std::vector<Side> sides;
  sides.reserve(3 * triangulation.cells.size());
  for (std::size_t K = 0; K < triangulation.cells.size(); ++K)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex a = triangulation.cells[K][(i + 1) % 3], b = triangulation.cells[K][(i + 2) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<LocalIndex>(K), i, a < b ? 0 : 1});
    }
  std::sort(sides.begin(), sides.end());
  return sides;
}

std::string at(const Triangulation& triangulation, LocalIndex vertex) {
  std::ostringstream text;
  text << '(' << triangulation.points[vertex][0] << ", " << triangulation.points[vertex][1] << ')';
  return text.str();
}

/// Counts the faces of sorted sides and throws unless each has one cell, or one on either side.
LocalIndex count_faces(const std::vector<Side>& sides, const Triangulation& triangulation) {
  LocalIndex faces = 0;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (k == 0 || !sides[k].same_face(sides[k - 1])) ++faces;
    else if (sides[k].slot == sides[k - 1].slot)
      throw core::InputError(triangulation.name + ": triangles overlap at the edge from " + at(triangulation, sides[k].low) + " to " +
                             at(triangulation, sides[k].high) + "; give a plane mesh in which an edge has two triangles at most.");
  }
  return faces;
}

void require_sound_cells(const Triangulation& triangulation, const HostMesh& host) {
  for (std::size_t K = 0; K < triangulation.cells.size(); ++K) {
    double longest = 0, farthest = 0;
    for (int i = 0; i < 3; ++i) {
      const auto &a = triangulation.points[triangulation.cells[K][i]], &b = triangulation.points[triangulation.cells[K][(i + 1) % 3]];
      longest = std::max(longest, std::hypot(b[0] - a[0], b[1] - a[1]));
      farthest = std::max({farthest, std::abs(a[0]), std::abs(a[1])});
    }
    if (const std::string mistake = lengths_mistake(farthest, longest); longest > 0 && !mistake.empty())
      throw core::InputError(triangulation.name + ": " + mistake);
    if (!(cell_area(host.parameter, host.cell_vertices, static_cast<LocalIndex>(K)) > 1e-14 * longest * longest))
      throw core::InputError(triangulation.name + ": the triangle at " + at(triangulation, triangulation.cells[K][0]) +
                             " has no area; give a mesh without degenerate triangles.");
  }
}

/// The groups in which the faces of the boundary lie, as positions in `names`.
struct Membership {
  std::vector<std::string> names;
  std::vector<std::pair<LocalIndex, std::vector<int>>> groups;  ///< of each face of the boundary

  Membership(const Triangulation& triangulation, const HostMesh& host, LocalIndex faces) : names(triangulation.tags) {
    const auto other = static_cast<int>(std::find(names.begin(), names.end(), "boundary") - names.begin());
    if (other == static_cast<int>(names.size())) names.emplace_back("boundary");
    std::vector<Side> segments;
    for (const auto& segment : triangulation.boundary)
      segments.push_back({std::min(segment.first, segment.second), std::max(segment.first, segment.second), 0, 0, segment.tag});
    std::sort(segments.begin(), segments.end());

    auto segment = segments.cbegin();
    for (LocalIndex F = 0; F < faces; ++F) {  // faces and segments are both in the order of their vertices
      const Side face = {host.face_vertices(F, 0), host.face_vertices(F, 1), 0, 0, -1};
      if (segment != segments.cend() && *segment < face) break;
      std::vector<int> here;
      for (; segment != segments.cend() && segment->same_face(face); ++segment)
        if (here.empty() || here.back() != segment->slot) here.push_back(segment->slot);
      if (host.face_cells(F, 0) >= 0 && host.face_cells(F, 1) >= 0) continue;
      if (here.empty()) here.push_back(other);
      groups.emplace_back(F, std::move(here));
    }
    if (segment != segments.cend())
      throw core::InputError(triangulation.name + ": the edge from " + at(triangulation, segment->low) + " to " +
                             at(triangulation, segment->high) + " of the group '" + names[segment->slot] +
                             "' is no side of a triangle; give a mesh of the plane part only, without loose edges.");
  }
};

/// The faces of the boundary that lie in the same groups are one part of it.
void tag_boundary(const Triangulation& triangulation, const HostMesh& host, Mesh& mesh) {
  const Membership membership(triangulation, host, mesh.faces);
  std::map<std::vector<int>, LocalIndex> parts;
  for (const auto& [F, groups] : membership.groups) parts.emplace(groups, 0);
  for (auto& [groups, part] : parts) {
    part = static_cast<LocalIndex>(mesh.tags.size());
    std::vector<std::string> names;
    for (const int group : groups) names.push_back(membership.names[group]);
    mesh.tags.push_back(core::join(names, intersection));
  }
  Kokkos::deep_copy(host.face_tag, -1);
  for (const auto& [F, groups] : membership.groups) host.face_tag(F) = parts.at(groups);
}

template <class Index>
void count_up(std::vector<Index>& numbers) {
  std::iota(numbers.begin(), numbers.end(), Index(0));
}

}  // namespace

Mesh make_mesh(const Triangulation& triangulation, const core::Comm& comm) {
  if (triangulation.cells.size() > static_cast<std::size_t>(std::numeric_limits<LocalIndex>::max() / 12))
    throw core::InputError(triangulation.name + ": the coarsest mesh is held by every rank; give a coarser one and more refinements.");
  const std::vector<Side> sides = sorted_sides(triangulation);
  Mesh mesh;
  mesh.comm = comm;
  mesh.global_cells = mesh.cells = static_cast<LocalIndex>(triangulation.cells.size());
  mesh.global_vertices = mesh.vertices = static_cast<LocalIndex>(triangulation.points.size());
  mesh.global_faces = mesh.faces = count_faces(sides, triangulation);
  mesh.owned_cells = mesh.comm.rank() == 0 ? mesh.cells : 0;
  mesh.refinement = triangulation.refinement;
  mesh.chart = triangulation.chart;

  const HostMesh host = allocate(mesh);
  count_up(mesh.cell_id);
  count_up(mesh.vertex_id);
  count_up(mesh.face_id);
  for (LocalIndex v = 0; v < mesh.vertices; ++v) {
    const auto [x, y] = triangulation.points[v];
    const Point point = physical(mesh.chart, {x, y});
    host.parameter(v, 0) = x, host.parameter(v, 1) = y;
    host.coordinates(v, 0) = point.x, host.coordinates(v, 1) = point.y;
  }
  for (LocalIndex K = 0; K < mesh.cells; ++K)
    for (int i = 0; i < 3; ++i) host.cell_vertices(K, i) = triangulation.cells[K][i];
  require_sound_cells(triangulation, host);

  Kokkos::deep_copy(host.face_cells, -1);
  LocalIndex F = -1;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Side& side = sides[k];
    if (k == 0 || !side.same_face(sides[k - 1])) ++F;
    host.face_vertices(F, 0) = side.low, host.face_vertices(F, 1) = side.high;
    host.face_cells(F, side.slot) = side.cell;
    host.cell_faces(side.cell, side.i) = F;
  }
  tag_boundary(triangulation, host, mesh);
  commit(host, mesh);
  return mesh;
}

}  // namespace thixis::mesh
