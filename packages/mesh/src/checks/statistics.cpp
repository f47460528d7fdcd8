#include "thixis/mesh/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::mesh {

Statistics statistics(const Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  const double infinity = std::numeric_limits<double>::infinity();
  Statistics s{0, infinity, 0, infinity, 0};
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    const double area = cell_area(host.coordinates, host.cell_vertices, K);
    double length[3];
    for (int i = 0; i < 3; ++i) length[i] = face_geometry(host.coordinates, host.face_vertices, host.cell_faces(K, i)).length;
    const double h = std::max({length[0], length[1], length[2]});
    s.area += area;
    s.h_min = std::min(s.h_min, h);
    s.h_max = std::max(s.h_max, h);
    for (int i = 0; i < 3; ++i) {
      // Angle at vertex i between the faces b, c: sin = 2|K|/(bc), cos = (b^2 + c^2 - a^2)/(2bc).
      const double a = length[i], b = length[(i + 1) % 3], c = length[(i + 2) % 3];
      const double angle = std::atan2(4 * area, b * b + c * c - a * a);
      s.smallest_angle = std::min(s.smallest_angle, angle);
      s.largest_angle = std::max(s.largest_angle, angle);
    }
  }
  return {mesh.comm.sum(s.area), mesh.comm.min(s.h_min), mesh.comm.max(s.h_max), mesh.comm.min(s.smallest_angle),
          mesh.comm.max(s.largest_angle)};
}

Box bounding_box(const Mesh& mesh) {
  const auto x = on_host(mesh).coordinates;
  std::vector<double> corner(4, -std::numeric_limits<double>::max());  // -lower, upper
  for (LocalIndex v = 0; v < mesh.vertices; ++v)
    for (int d = 0; d < 2; ++d) {
      corner[d] = std::max(corner[d], -x(v, d));
      corner[2 + d] = std::max(corner[2 + d], x(v, d));
    }
  mesh.comm.max(corner);
  return {{-corner[0], -corner[1]}, {corner[2], corner[3]}};
}

}  // namespace thixis::mesh
