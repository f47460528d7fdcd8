#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "checks/membrane_checks.hpp"
#include "scene/point_list.hpp"
#include "thixis/mesh/host.hpp"

/// What the checks share.
namespace thixis::membranes {

/// Points of the faces of a part of the boundary on this rank: their ends, or those of the quadrature of Neumann data.
inline PointList points_on(const mesh::Mesh& mesh, const mesh::HostMesh& host, std::size_t tag, const std::vector<double>& along) {
  PointList points;
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    if (host.face_tag(F) != static_cast<LocalIndex>(tag)) continue;
    const LocalIndex a = host.face_vertices(F, 0), b = host.face_vertices(F, 1);
    for (const double t : along)
      points.add((1 - t) * host.coordinates(a, 0) + t * host.coordinates(b, 0),
                 (1 - t) * host.coordinates(a, 1) + t * host.coordinates(b, 1));
  }
  return points;
}

/// The deck's names of what belongs to membrane alpha: g1, g2; g over an obstacle.
inline std::string named(const MembraneScene& scene, const char* letter, int alpha) {
  return scene.count == 1 ? letter : letter + std::to_string(alpha + 1);
}

inline std::string and_time(double t) { return t > 0 ? fmt::format(", t = {:.6g}", t) : ""; }

}  // namespace thixis::membranes
