#include "checks/membrane_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "checks/check_points.hpp"
#include "checks/degree_check.hpp"
#include "scene/exact_gradient.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/groups.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::membranes {
namespace {

constexpr double smallest_tension = 1e-60;  // whose reciprocal is no more than scene::largest_value

/// Throws where a tension is not positive or another function of the user is not finite: at the points where the run will ask for it, but
/// before anything is written. Collective.
void check_data(const MembraneScene& scene, const method::MethodParams& method, const mesh::Mesh& mesh) {
  const auto quadrature = method::make_quadrature(mesh, method::owned_cells(mesh), method.order(), scene.interface_level_set);
  double lowest[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::vector<scene::FieldPtr> exact[2];
  for (int alpha = 0; scene.exact && alpha < scene.count; ++alpha) {
    const auto slope = exact_gradient(*scene.exact, alpha, mesh);
    exact[alpha] = {scene.exact->u[alpha], slope[0], slope[1]};
  }
  mesh.comm.together([&] {
    const mesh::View<double*> values("thixis::membranes::data", quadrature.largest_block);
    const auto on_host = Kokkos::create_mirror_view(values);
    method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
      if (scene.obstacle) method::evaluate(*scene.obstacle, 0, block, values);
      for (int alpha = 0; alpha < scene.count; ++alpha) {
        method::evaluate(*scene.force[alpha], 0, block, values);
        for (const auto& known : exact[alpha]) method::evaluate(*known, 0, block, values);
        method::evaluate(*scene.tension[alpha], 0, block, values);
        Kokkos::deep_copy(on_host, values);
        for (int q = 0; q < block.points; ++q) lowest[alpha] = std::min(lowest[alpha], on_host(q));
      }
    });
  });
  for (int alpha = 0; alpha < scene.count; ++alpha)
    if (const double tension = mesh.comm.min(lowest[alpha]); !(tension >= smallest_tension))
      throw core::InputError(fmt::format("scene/data/{}: the tension falls to {:.6g}{}.", named(scene, "mu", alpha), tension,
                                         tension > 0 ? fmt::format(", too small to compute with; write the data in units in which it is at "
                                                                   "least {:g}",
                                                                   smallest_tension)
                                                     : "; give one that is positive everywhere"));
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

}  // namespace

void check_order(const scene::FieldPtr (&initial)[2], const method::MethodParams& method, const mesh::Mesh& mesh) {
  const auto rule = reference::triangle_quadrature(method.order());
  mesh.comm.together([&] {
    const auto host = mesh::on_host(mesh);
    PointList at;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
      const auto add = [&](double xi, double eta) {
        const double lambda[3] = {1 - xi - eta, xi, eta};
        double x[2] = {0, 0};
        for (int a = 0; a < 3; ++a)
          for (int d = 0; d < 2; ++d) x[d] += lambda[a] * host.coordinates(host.cell_vertices(K, a), d);
        at.add(x[0], x[1]);
      };
      for (const auto& [xi, eta] : {std::pair(0.0, 0.0), std::pair(1.0, 0.0), std::pair(0.0, 1.0)}) add(xi, eta);
      for (int q = 0; q < rule.size(); ++q) add(rule.point[2 * q], rule.point[2 * q + 1]);
    }
    const auto upper = at.evaluate(*initial[0]), lower = at.evaluate(*initial[1]);
    double size = 0;
    for (std::size_t i = 0; i < upper.size(); ++i) size = std::max({size, std::abs(upper[i]), std::abs(lower[i])});
    for (std::size_t i = 0; i < upper.size(); ++i)
      if (upper[i] < lower[i] - 1e-12 * size)
        throw core::InputError(
            fmt::format("scene/data/initial: the upper membrane begins below the lower one: u1 = {:.6g} < u2 = {:.6g} at ({:.6g}, {:.6g}); "
                        "give initial values with u1 >= u2.",
                        upper[i], lower[i], at.x[i], at.y[i]));
  });
}

void check_functions(const MembraneScene& scene, const std::array<scene::FieldPtr, 3>& initial, const method::MethodParams& method,
                     const mesh::Mesh& mesh) {
  const Boundary boundary = boundary_of(scene, mesh);
  check_boundary(scene, boundary, method, mesh, 0);
  check_initial(initial, mesh);
  if (scene.name == "data") check_data(scene, method, mesh);
  check_degrees(scene, boundary, mesh);
}

std::vector<mesh::Place> place(const std::vector<models::Probe>& probes, const mesh::Mesh& mesh) {
  std::vector<std::array<double, 2>> points;
  for (const auto& probe : probes) points.push_back(probe.at);
  auto places = mesh::locate(mesh, points);
  for (std::size_t i = 0; i < probes.size(); ++i)
    if (!places[i].inside)
      throw core::InputError(fmt::format("{}: the point ({:.6g}, {:.6g}) lies outside of the mesh; take one inside.", probes[i].path,
                                         points[i][0], points[i][1]));
  return places;
}

void check_field_names(const MembraneScene& scene, const std::vector<std::string>& names) {
  std::vector<std::string> known = {"lambda", "gap", "active"};
  for (int alpha = scene.count - 1; alpha >= 0; --alpha) known.insert(known.begin(), named(scene, "u", alpha));
  for (const auto& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw core::InputError(
          fmt::format("output/fields: there is no field '{}'; write all, none, or some of {}.", name, fmt::join(known, ", ")));
}

}  // namespace thixis::membranes
