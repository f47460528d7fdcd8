#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "thixis/core/error.hpp"
#include "thixis/mesh/host.hpp"
#include "triangulation.hpp"

namespace thixis::mesh {
namespace {

struct Boundary {
  HostView<double* [2]> x;
  std::vector<std::array<LocalIndex, 2>> faces;  ///< their vertices
  std::vector<int> degree;                       ///< faces of the boundary at each vertex
  std::vector<double> shortest;                  ///< length of the shortest face at each vertex
};

Boundary boundary_of(const Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  Boundary boundary{
      host.coordinates, {}, std::vector<int>(mesh.vertices, 0), std::vector<double>(mesh.vertices, std::numeric_limits<double>::max())};
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    const LocalIndex a = host.face_vertices(F, 0), b = host.face_vertices(F, 1);
    const double length = std::hypot(boundary.x(b, 0) - boundary.x(a, 0), boundary.x(b, 1) - boundary.x(a, 1));
    for (const LocalIndex v : {a, b}) boundary.shortest[v] = std::min(boundary.shortest[v], length);
    if (host.face_tag(F) < 0) continue;
    boundary.faces.push_back({a, b});
    for (const LocalIndex v : {a, b}) ++boundary.degree[v];
  }
  return boundary;
}

std::string at(const Boundary& boundary, LocalIndex v) {
  std::ostringstream text;
  text << '(' << boundary.x(v, 0) << ", " << boundary.x(v, 1) << ')';
  return text.str();
}

void require_vertices_off_faces(const Boundary& boundary, const std::string& name) {
  const HostView<double* [2]>& x = boundary.x;
  // A vertex can lie on a face only if both have the same projection on a line; an unlikely direction keeps the candidates few.
  const double dx = std::cos(1.0), dy = std::sin(1.0);
  const auto projection = [&](LocalIndex v) { return dx * x(v, 0) + dy * x(v, 1); };
  std::vector<std::pair<double, LocalIndex>> order;
  for (std::size_t v = 0; v < boundary.degree.size(); ++v)
    if (boundary.degree[v] > 0) order.emplace_back(projection(static_cast<LocalIndex>(v)), v);
  std::sort(order.begin(), order.end());

  for (const auto& [a, b] : boundary.faces) {
    const double ex = x(b, 0) - x(a, 0), ey = x(b, 1) - x(a, 1), length = std::hypot(ex, ey), nearest = 1e-9 * length;
    const double low = std::min(projection(a), projection(b)), high = std::max(projection(a), projection(b));
    auto candidate = std::lower_bound(order.begin(), order.end(), std::make_pair(low - nearest, LocalIndex(-1)));
    for (; candidate != order.end() && candidate->first <= high + nearest; ++candidate) {
      const LocalIndex v = candidate->second;
      const double near = std::min(nearest, 1e-3 * boundary.shortest[v]);  // thin domains are no narrower than their cells
      const double vx = x(v, 0) - x(a, 0), vy = x(v, 1) - x(a, 1);
      const double along = (vx * ex + vy * ey) / length, across = (ex * vy - ey * vx) / length;
      if (v == a || v == b || std::abs(across) > near || along < -near || along > length + near) continue;
      const bool at_end = along < near || along > length - near;
      throw core::InputError(name + (at_end ? ": two nodes of the boundary lie at " : ": a node of the boundary lies inside an edge at ") +
                             at(boundary, v) + "; give a conforming mesh (in Gmsh: merge duplicate nodes or entities with Coherence).");
    }
  }
}

}  // namespace

void require_simple_boundary(const Mesh& mesh, const std::string& name) {
  const Boundary boundary = boundary_of(mesh);
  require_vertices_off_faces(boundary, name);
  const auto touching = std::find_if(boundary.degree.begin(), boundary.degree.end(), [](int degree) { return degree > 2; });
  if (touching != boundary.degree.end())
    throw core::InputError(name + ": the domain touches itself in the vertex " +
                           at(boundary, static_cast<LocalIndex>(touching - boundary.degree.begin())) +
                           "; give a mesh whose boundary is made of simple closed curves.");
}

}  // namespace thixis::mesh
