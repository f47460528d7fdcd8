#include "membrane_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "thixis/core/error.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::models {
namespace {

struct PointList {
  std::vector<double> x, y;
  void add(double px, double py) {
    x.push_back(px);
    y.push_back(py);
  }
  std::vector<double> evaluate(const scene::Field& field) const {
    std::vector<double> values(x.size());
    field.evaluate({x.size(), x.data(), y.data()}, 0, values.data());
    return values;
  }
};

/// Points of the faces of a part of the boundary on this rank: their ends, or those of the quadrature of Neumann data.
PointList points_on(const mesh::Mesh& mesh, const mesh::HostMesh& host, std::size_t tag, const std::vector<double>& along) {
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

/// Throws where g1 < g2 at an end of a held face (membranes that cross at their boundary have no solution), and where boundary data are not
/// finite. Collective.
void check_boundary(const scene::MembraneScene& scene, const Boundary& boundary, int order, const mesh::Mesh& mesh) {
  const std::vector<double> ends = {0, 1}, inside = reference::line_quadrature(order).point;
  mesh.comm.together([&] {
    const auto host = mesh::on_host(mesh);
    for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
      const PointList at = points_on(mesh, host, tag, boundary.dirichlet[tag] ? ends : inside);
      if (!boundary.dirichlet[tag]) {
        for (const auto& values : boundary.values) at.evaluate(*values.neumann[tag]);
        continue;
      }
      const auto upper = at.evaluate(*boundary.values[0].dirichlet[tag]), lower = at.evaluate(*boundary.values[1].dirichlet[tag]);
      for (std::size_t i = 0; i < upper.size(); ++i)
        if (upper[i] < lower[i] - 1e-12 * (std::abs(upper[i]) + std::abs(lower[i])))
          throw core::InputError(
              fmt::format("{}: on the boundary '{}' the upper membrane lies below the lower one: g1 = {:.6g} < g2 = {:.6g} "
                          "at ({:.6g}, {:.6g}); give boundary data with g1 >= g2.",
                          scene.boundary.count(mesh.tags[tag]) > 0 ? "scene/boundary/" + mesh.tags[tag] : "scene/data/g1", mesh.tags[tag],
                          upper[i], lower[i], at.x[i], at.y[i]));
    }
  });
}

/// Throws where a tension is not positive or another function of the user is not finite: at the points where the run will ask for it, but
/// before anything is written. Collective.
void check_data(const scene::MembraneScene& scene, const method::MethodParams& method, const mesh::Mesh& mesh) {
  const auto quadrature = method::make_quadrature(mesh, method::owned_cells(mesh), method.order(), scene.interface_level_set);
  double lowest[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  mesh.comm.together([&] {
    const mesh::View<double*> values("thixis::models::data", quadrature.largest_block);
    const auto on_host = Kokkos::create_mirror_view(values);
    method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
      for (int alpha = 0; alpha < 2; ++alpha) {
        method::evaluate(*scene.force[alpha], 0, block, values);
        if (scene.exact)
          for (const auto& known : {scene.exact->u[alpha], scene.exact->gradient[alpha][0], scene.exact->gradient[alpha][1]})
            method::evaluate(*known, 0, block, values);
        method::evaluate(*scene.tension[alpha], 0, block, values);
        Kokkos::deep_copy(on_host, values);
        for (int q = 0; q < block.points; ++q) lowest[alpha] = std::min(lowest[alpha], on_host(q));
      }
    });
  });
  for (int alpha = 0; alpha < 2; ++alpha)
    if (const double tension = mesh.comm.min(lowest[alpha]); !(tension > 0))
      throw core::InputError(
          fmt::format("scene/data/mu{}: the tension falls to {:.6g}; give one that is positive everywhere.", alpha + 1, tension));
}

/// Throws where the functions that a cold start begins with are not finite. Collective.
void check_initial(const std::array<scene::FieldPtr, 3>& initial, const mesh::Mesh& mesh) {
  if (std::none_of(initial.begin(), initial.end(), [](const auto& field) { return field != nullptr; })) return;
  mesh.comm.together([&] {
    PointList vertices;
    const auto coordinates = mesh::on_host(mesh).coordinates;
    for (LocalIndex v = 0; v < mesh.vertices; ++v) vertices.add(coordinates(v, 0), coordinates(v, 1));
    for (const auto& field : initial)
      if (field) vertices.evaluate(*field);
  });
}

const char* const known_fields[] = {"u1", "u2", "lambda", "gap", "active"};

}  // namespace

Boundary boundary_of(const scene::MembraneScene& scene, const mesh::Mesh& mesh) {
  for (const auto& [tag, condition] : scene.boundary)
    if (std::find(mesh.tags.begin(), mesh.tags.end(), tag) == mesh.tags.end()) {
      std::string names;
      for (const auto& name : mesh.tags) names += (names.empty() ? "" : ", ") + name;
      throw core::InputError("scene/boundary/" + tag + ": the mesh has no such part of the boundary; write one of: " + names + ".");
    }
  Boundary boundary;
  for (const auto& tag : mesh.tags) {
    const auto given = scene.boundary.find(tag);
    const auto& condition = given == scene.boundary.end() ? scene.default_boundary : given->second;
    const bool dirichlet = condition.kind == scene::BoundaryKind::dirichlet;
    if (dirichlet && !(condition.value[0] && condition.value[1]))
      throw core::InputError(
          "scene/boundary/" + tag +
          ": nothing is said about this part of the boundary; give g1 and g2 there, or g1 and g2 in scene/data for all of it.");
    boundary.dirichlet.push_back(dirichlet);
    for (int alpha = 0; alpha < 2; ++alpha) {
      boundary.values[alpha].dirichlet.push_back(dirichlet ? condition.value[alpha] : nullptr);
      boundary.values[alpha].neumann.push_back(dirichlet ? nullptr : condition.value[alpha]);
    }
  }
  if (std::find(boundary.dirichlet.begin(), boundary.dirichlet.end(), true) == boundary.dirichlet.end())
    throw core::InputError(
        "scene/boundary: no part of the boundary has kind dirichlet, so the membranes are free to float away; fix at least one.");
  return boundary;
}

void check_functions(const scene::MembraneScene& scene, const std::array<scene::FieldPtr, 3>& initial, const method::MethodParams& method,
                     const mesh::Mesh& mesh) {
  check_boundary(scene, boundary_of(scene, mesh), method.order(), mesh);
  check_initial(initial, mesh);
  if (scene.name == "data") check_data(scene, method, mesh);
}

void check_field_names(const std::vector<std::string>& names) {
  for (const auto& name : names)
    if (std::find(std::begin(known_fields), std::end(known_fields), name) == std::end(known_fields))
      throw core::InputError(
          fmt::format("output/fields: there is no field '{}'; write all, none, or some of {}.", name, fmt::join(known_fields, ", ")));
}

}  // namespace thixis::models
