#include "membrane_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "degree_check.hpp"
#include "exact_gradient.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/groups.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::membranes {
namespace {

constexpr double smallest_tension = 1e-60;  // whose reciprocal is no more than scene::largest_value

struct PointList {
  std::vector<double> x, y;
  void add(double px, double py) {
    x.push_back(px);
    y.push_back(py);
  }
  std::vector<double> evaluate(const scene::Field& field, double t = 0) const {
    std::vector<double> values(x.size());
    field.evaluate({x.size(), x.data(), y.data()}, t, values.data());
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

/// The deck's names of what belongs to membrane alpha: g1, g2; g over an obstacle.
std::string named(const MembraneScene& scene, const char* letter, int alpha) {
  return scene.count == 1 ? letter : letter + std::to_string(alpha + 1);
}

std::string and_time(double t) { return t > 0 ? fmt::format(", t = {:.6g}", t) : ""; }

/// Throws where the values of two held parts of the boundary differ at a vertex where they meet: no function of finite energy has such
/// boundary values. Every owned vertex has all its faces on this rank. Collective.
void check_jumps(const MembraneScene& scene, const Boundary& boundary, const mesh::Mesh& mesh, double t) {
  const std::size_t tags = boundary.dirichlet.size();
  const auto host = mesh::on_host(mesh);
  std::vector<std::vector<double>> values(tags * scene.count);
  std::vector<PointList> ends(tags);
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  mesh.comm.together([&] {
    for (std::size_t tag = 0; tag < tags; ++tag) {
      if (!boundary.dirichlet[tag]) continue;
      ends[tag] = points_on(mesh, host, tag, {0, 1});
      for (int alpha = 0; alpha < scene.count; ++alpha) {
        auto& found = values[tag * scene.count + alpha] = ends[tag].evaluate(*boundary.values[alpha].dirichlet[tag], t);
        for (const double value : found) {
          lowest = std::min(lowest, value);
          highest = std::max(highest, value);
        }
      }
    }
  });
  lowest = mesh.comm.min(lowest);
  highest = mesh.comm.max(highest);
  if (lowest > highest) return;
  const double rounding = 1e-14 * std::max(std::abs(lowest), std::abs(highest));
  const double allowed = 1e-8 * (highest - lowest) + rounding;
  struct First {
    std::size_t tag, end;  ///< tag = tags: none yet
  };
  mesh.comm.together([&] {
    std::vector<First> first(mesh.vertices, First{tags, 0});
    std::vector<std::size_t> count(tags, 0);
    for (LocalIndex F = 0; F < mesh.faces; ++F) {
      if (host.face_tag(F) < 0) continue;
      const auto tag = static_cast<std::size_t>(host.face_tag(F));
      if (!boundary.dirichlet[tag]) continue;
      for (int side = 0; side < 2; ++side) {
        const std::size_t end = count[tag]++;
        First& other = first[host.face_vertices(F, side)];
        if (other.tag == tags) other = {tag, end};
        for (int alpha = 0; alpha < scene.count && other.tag != tag; ++alpha) {
          const auto [low, high] = std::minmax(other.tag, tag);
          const double here = values[tag * scene.count + alpha][end], there = values[other.tag * scene.count + alpha][other.end];
          if (std::abs(here - there) > allowed)
            throw core::InputError(fmt::format(
                "scene/boundary: {} jumps where the parts '{}' and '{}' of the boundary meet, at ({:.6g}, {:.6g}){}: {:.6g} and {:.6g}; no "
                "solution of finite energy exists then. Give data that agree there, such as a steep ramp.",
                named(scene, "g", alpha), mesh.tags[low], mesh.tags[high], ends[tag].x[end], ends[tag].y[end], and_time(t),
                low == tag ? here : there, low == tag ? there : here));
        }
      }
    }
  });
}

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

/// The largest divisor of n up to 32: every so many points of a generator's boundary are some of those of n.
int divisor(int n) {
  int d = std::min(n, 32);
  while (n % d != 0) --d;
  return d;
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

void check_boundary(const MembraneScene& scene, const Boundary& boundary, const method::MethodParams& method, const mesh::Mesh& mesh,
                    double t) {
  const std::vector<double> inside = reference::line_quadrature(method.order()).point;
  std::vector<double> held = {0, 1};  // the ends, and for degree >= 2 inside, too
  if (method.degree > 1) held.insert(held.end(), inside.begin(), inside.end());
  const bool one = scene.count == 1;
  mesh.comm.together([&] {
    const auto host = mesh::on_host(mesh);
    for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
      const PointList at = points_on(mesh, host, tag, boundary.dirichlet[tag] ? held : inside);
      if (!boundary.dirichlet[tag]) {
        for (int alpha = 0; alpha < scene.count; ++alpha) at.evaluate(*boundary.values[alpha].neumann[tag], t);
        continue;
      }
      const auto upper = at.evaluate(*boundary.values[0].dirichlet[tag], t),
                 lower = at.evaluate(one ? *scene.obstacle : *boundary.values[1].dirichlet[tag], t);
      double size = 0;
      for (std::size_t i = 0; i < upper.size(); ++i) size = std::max({size, std::abs(upper[i]), std::abs(lower[i])});
      for (std::size_t i = 0; i < upper.size(); ++i)
        if (upper[i] < lower[i] - 1e-12 * size)
          throw core::InputError(fmt::format(
              "{}: on the boundary '{}' {}: {} = {:.6g} < {} = {:.6g} at ({:.6g}, {:.6g}){}; give boundary data with {} >= {}.",
              boundary.named[tag].empty() ? "scene/data/" + named(scene, "g", 0) : "scene/boundary/" + boundary.named[tag], mesh.tags[tag],
              one ? "the membrane lies below the obstacle" : "the upper membrane lies below the lower one", named(scene, "g", 0), upper[i],
              one ? "psi" : "g2", lower[i], at.x[i], at.y[i], and_time(t), named(scene, "g", 0), one ? "psi" : "g2"));
    }
  });
  check_jumps(scene, boundary, mesh, t);
}

void check_boundary(const MembraneScene& scene, const mesh::MeshParams& params, const std::vector<double>& times) {
  if (params.generator == mesh::Generator::file) return;
  mesh::MeshParams coarse = params;
  coarse.refinements = 0;
  coarse.cells_per_side = divisor(params.cells_per_side);
  coarse.rings = divisor(params.rings);
  const auto hierarchy = mesh::build(coarse, core::Comm(MPI_COMM_SELF), "");
  Boundary boundary = boundary_of(scene, hierarchy.finest());
  for (auto& membrane : boundary.values)  // integrated, and not asked for at vertices
    for (auto& traction : membrane.neumann)
      if (traction) traction = scene::constant(0);
  for (const double t : times) check_boundary(scene, boundary, {}, hierarchy.finest(), t);
}

bool steady(const std::vector<scene::FieldPtr>& fields) {
  return std::all_of(fields.begin(), fields.end(), [](const scene::FieldPtr& field) { return !field || field->steady(); });
}

bool steady_boundary(const MembraneScene& scene) {
  const auto is_steady = [](const BoundaryCondition& condition) {
    return condition.kind == BoundaryKind::neumann || steady({condition.value[0], condition.value[1]});
  };
  return is_steady(scene.default_boundary) &&
         std::all_of(scene.boundary.begin(), scene.boundary.end(), [&](const auto& part) { return is_steady(part.second); });
}

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

Boundary boundary_of(const MembraneScene& scene, const mesh::Mesh& mesh) {
  std::vector<std::string> names;
  for (const auto& [name, condition] : scene.boundary) names.push_back(name);
  Boundary boundary;
  boundary.named = mesh::named_groups(mesh.tags, names, "scene/boundary");
  for (std::size_t tag = 0; tag < mesh.tags.size(); ++tag) {
    const auto given = scene.boundary.find(boundary.named[tag]);
    const auto& condition = given == scene.boundary.end() ? scene.default_boundary : given->second;
    const bool dirichlet = condition.kind == BoundaryKind::dirichlet;
    const bool known = condition.value[0] && (scene.count == 1 || condition.value[1]);
    if (dirichlet && !known)
      throw core::InputError(fmt::format(
          "scene/boundary/{0}: nothing is said about this part of the boundary; give {1} there, or {1} in scene/data for all of it.",
          boundary.named[tag].empty() ? mesh.tags[tag] : boundary.named[tag], scene.count == 1 ? "g" : "g1 and g2"));
    boundary.dirichlet.push_back(dirichlet);
    for (int alpha = 0; alpha < scene.count; ++alpha) {
      boundary.values[alpha].dirichlet.push_back(dirichlet ? condition.value[alpha] : nullptr);
      boundary.values[alpha].neumann.push_back(dirichlet ? nullptr : condition.value[alpha]);
    }
  }
  return boundary;
}

void check_held(const MembraneScene& scene, const Boundary& boundary) {
  if (std::find(boundary.dirichlet.begin(), boundary.dirichlet.end(), true) != boundary.dirichlet.end()) return;
  throw core::InputError(
      scene.obstacle
          ? "scene/boundary: no part of the boundary has kind dirichlet; a membrane that nothing but the obstacle can hold is not "
            "served: fix at least one part."
          : "scene/boundary: no part of the boundary has kind dirichlet, so the membranes are free to float away; fix at least one.");
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
