#include "scene/heights.hpp"

#include "scene/point_list.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/scene/shifted.hpp"

namespace thixis::membranes {
namespace {

/// Takes in the values at the vertices that are marked.
void take(const scene::Field& field, const mesh::HostMesh& host, const std::vector<bool>& marked, double t, double& low, double& high) {
  PointList at;
  for (std::size_t v = 0; v < marked.size(); ++v)
    if (marked[v]) at.add(host.coordinates(v, 0), host.coordinates(v, 1));
  for (const double value : at.evaluate(field, t)) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
}

}  // namespace

Heights heights_of(const MembraneScene& scene, const mesh::Mesh& mesh, double t) {
  const Boundary boundary = boundary_of(scene, mesh);
  const auto host = mesh::on_host(mesh);
  Heights heights;
  const bool held = std::find(boundary.dirichlet.begin(), boundary.dirichlet.end(), true) != boundary.dirichlet.end();
  mesh.comm.together([&] {
    for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
      if (!boundary.dirichlet[tag]) continue;
      std::vector<bool> on_tag(mesh.vertices, false);
      for (LocalIndex F = 0; F < mesh.faces; ++F)
        if (host.face_tag(F) == static_cast<LocalIndex>(tag))
          for (int end = 0; end < 2; ++end) on_tag[host.face_vertices(F, end)] = true;
      for (int alpha = 0; alpha < scene.count; ++alpha)
        take(*boundary.values[alpha].dirichlet[tag], host, on_tag, t, heights.low[alpha], heights.high[alpha]);
    }
    for (int alpha = 0; alpha < scene.count && !held; ++alpha)
      if (scene.initial[alpha])
        take(*scene.initial[alpha], host, std::vector<bool>(mesh.vertices, true), t, heights.low[alpha], heights.high[alpha]);
  });
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    heights.low[alpha] = mesh.comm.min(heights.low[alpha]);
    heights.high[alpha] = mesh.comm.max(heights.high[alpha]);
  }
  return heights;
}

MembraneScene counted_from(double origin, MembraneScene scene) {
  const auto lower = [origin](scene::FieldPtr& height) { height = scene::shifted(height, -origin); };
  const auto lower_held = [&](BoundaryCondition& condition) {
    if (condition.kind == BoundaryKind::dirichlet)
      for (scene::FieldPtr& value : condition.value) lower(value);
  };
  lower_held(scene.default_boundary);
  for (auto& [tag, condition] : scene.boundary) lower_held(condition);
  lower(scene.obstacle);
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    lower(scene.initial[alpha]);
    if (scene.exact) lower(scene.exact->u[alpha]);
  }
  return scene;
}

}  // namespace thixis::membranes
