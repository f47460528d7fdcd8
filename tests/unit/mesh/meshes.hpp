#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "thixis/mesh/build.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

inline Hierarchy criss_cross(int cells_per_side, int refinements, const core::Comm& comm = core::Comm(), int cells_per_rank = 100) {
  MeshParams params;
  params.cells_per_side = cells_per_side;
  params.refinements = refinements;
  params.cells_per_rank = cells_per_rank;
  return build(params, comm, ".");
}

inline Hierarchy rectangle(int cells_per_side, int refinements, const core::Comm& comm = core::Comm(), int cells_per_rank = 100) {
  MeshParams params;
  params.generator = Generator::rectangle;
  params.cells_per_side = cells_per_side;
  params.lower = {-1, 0.5};
  params.upper = {2, 2};
  params.refinements = refinements;
  params.cells_per_rank = cells_per_rank;
  return build(params, comm, ".");
}

inline Hierarchy disk(int rings, int refinements, const core::Comm& comm = core::Comm(), int cells_per_rank = 100) {
  MeshParams params;
  params.generator = Generator::disk;
  params.rings = rings;
  params.refinements = refinements;
  params.cells_per_rank = cells_per_rank;
  return build(params, comm, ".");
}

/// The points and triangles of a mesh whatever their numbering; points are told apart by 1e-9.
struct PlainMesh {
  using Key = std::array<long long, 2>;
  std::map<Key, std::array<double, 2>> points;
  std::set<std::array<Key, 3>> triangles;

  explicit PlainMesh(const Mesh& mesh) {
    const HostMesh host = on_host(mesh);
    std::vector<std::array<double, 6>> owned;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
      std::array<double, 6> corners;
      for (int i = 0; i < 6; ++i) corners[i] = host.coordinates(host.cell_vertices(K, i / 2), i % 2);
      owned.push_back(corners);
    }
    for (const auto& corners : mesh.comm.gather(owned)) {
      std::array<Key, 3> triangle;
      for (int i = 0; i < 3; ++i) {
        const double x = corners[2 * i], y = corners[2 * i + 1];
        triangle[i] = {std::llround(x * 1e9), std::llround(y * 1e9)};
        points.emplace(triangle[i], std::array<double, 2>{x, y});
      }
      std::sort(triangle.begin(), triangle.end());
      triangles.insert(triangle);
    }
  }

  /// Largest distance of the points of both meshes that belong to each other; infinite if some have none.
  double distance(const PlainMesh& other) const {
    double largest = points.size() == other.points.size() ? 0 : INFINITY;
    for (const auto& [key, point] : points) {
      const auto found = other.points.find(key);
      if (found == other.points.end()) return INFINITY;
      largest = std::max(largest, std::hypot(point[0] - found->second[0], point[1] - found->second[1]));
    }
    return largest;
  }
};

}  // namespace thixis::mesh
