#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "checks/check_points.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::membranes {
namespace {

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

/// The largest divisor of n up to 32: every so many points of a generator's boundary are some of those of n.
int divisor(int n) {
  int d = std::min(n, 32);
  while (n % d != 0) --d;
  return d;
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

void check_held(const MembraneScene& scene, const Boundary& boundary) {
  if (std::find(boundary.dirichlet.begin(), boundary.dirichlet.end(), true) != boundary.dirichlet.end()) return;
  throw core::InputError(
      scene.obstacle
          ? "scene/boundary: no part of the boundary has kind dirichlet; a membrane that nothing but the obstacle can hold is not "
            "served: fix at least one part."
          : "scene/boundary: no part of the boundary has kind dirichlet, so the membranes are free to float away; fix at least one.");
}

}  // namespace thixis::membranes
