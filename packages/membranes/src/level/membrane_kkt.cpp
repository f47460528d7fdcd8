#include "level/membrane_kkt.hpp"

#include <algorithm>
#include <cmath>

#include "scene/point_list.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/mesh/statistics.hpp"
#include "thixis/method/measures.hpp"

namespace thixis::membranes {
namespace {

using algebra::Vector;
using method::Coefficients;

/// Collective.
double area_of(const mesh::Mesh& mesh) {
  const auto coordinates = mesh.coordinates;
  const auto vertices = mesh.cell_vertices;
  double area = 0;
  Kokkos::parallel_reduce(
      "thixis::membranes::area", Kokkos::RangePolicy<>(0, mesh.owned_cells),
      KOKKOS_LAMBDA(int K, double& sum) { sum += mesh::cell_area(coordinates, vertices, K); }, area);
  return mesh.comm.sum(area);
}

/// The part of v at the contact points.
Teuchos::RCP<Vector> at_points(const Vector& v, const MembraneOperator& membranes) {
  auto part = Teuchos::rcp(new Vector(membranes.points()));
  const auto in = algebra::host_view(v);
  const auto out = algebra::host_overwrite(*part);
  for (std::size_t l = 0; l < out.extent(0); ++l) out(l) = in(l);
  return part;
}

/// Largest tension at the vertices. Collective.
double largest_tension(const scene::Field& tension, const mesh::Mesh& mesh) {
  if (const double* constant = tension.constant()) return *constant;
  const auto x = mesh::on_host(mesh).coordinates;
  PointList vertices;
  for (LocalIndex v = 0; v < mesh.vertices; ++v) vertices.add(x(v, 0), x(v, 1));
  const auto mu = mesh.comm.together([&] { return vertices.evaluate(tension); });
  return mesh.comm.max(mu.empty() ? 0.0 : *std::max_element(mu.begin(), mu.end()));
}

/// Largest |v_l| at nodes that are no contact points. Collective.
double largest_elsewhere(const Vector& v, LocalIndex points) {
  const auto values = algebra::host_view(v);
  double value = 0;
  for (std::size_t l = points; l < values.extent(0); ++l) value = std::max(value, std::abs(values(l)));
  return algebra::comm_of(*v.getMap()).max(value);
}

/// Forces that matter at one point: those on a membrane, those that contact passes on.
struct PointForces {
  std::vector<double> on_membrane;
  double through_contact = 0;
};

/// `largest`: what is there at some point. Whatever it is, the force counts that bends a membrane to its height over the width of the
/// domain; what drives the gap acts on both; round-off counts as nothing.
PointForces point_forces(const MembraneSolution& solution, std::vector<double> largest) {
  const MembraneOperator& membranes = solution.on_mesh.problem().membranes();
  const MembraneMeasure& measure = solution.on_mesh.problem().measure();
  const mesh::Mesh& mesh = solution.on_mesh.space().mesh();
  const double width = mesh::bounding_box(mesh).diagonal(), area = area_of(mesh);
  const auto points = static_cast<double>(std::max<std::size_t>(membranes.points()->getGlobalNumElements(), 1));
  PointForces forces;
  for (int alpha = 0; alpha < membranes.count(); ++alpha) {
    const double curvature = measure.displacement(alpha, solution.x.u) / (width * width);
    largest[alpha] = std::max(largest[alpha], largest_tension(*solution.on_mesh.scene().tension[alpha], mesh) * curvature * area / points);
    forces.through_contact += (membranes.count() == 1 ? 1 : membranes.theta[1 - alpha]) * largest[alpha];
  }
  for (int alpha = 0; alpha < membranes.count(); ++alpha)
    forces.on_membrane.push_back(std::max(largest[alpha], forces.through_contact) +
                                 measure.round_off(alpha, solution.x.u) / MembraneMeasure::smallest_digit);
  forces.through_contact = *std::min_element(forces.on_membrane.begin(), forces.on_membrane.end());
  const auto or_one = [](double& force) { force = force > 0 ? force : 1; };  // nothing acts: all is zero, exactly
  or_one(forces.through_contact);
  std::for_each(forces.on_membrane.begin(), forces.on_membrane.end(), or_one);
  return forces;
}

}  // namespace

complementarity::KktData kkt_data(const MembraneSolution& solution) {
  const auto& [on_mesh, x, u, rate] = solution;
  const MembraneScene& scene = on_mesh.scene();
  const method::Space& space = on_mesh.space();
  const MembraneOperator& membranes = on_mesh.problem().membranes();
  const MembraneMeasure& measure = on_mesh.problem().measure();
  const LocalIndex points = algebra::local_size(*membranes.points());
  complementarity::KktData data;
  auto gap_l = Teuchos::rcp(new Vector(membranes.points()));
  gap(membranes, x.u, *gap_l);
  data.gap = gap_l;
  auto claimed = Teuchos::rcp(new Vector(membranes.points()));
  claimed->elementWiseMultiply(1, space.pairing(), x.lambda, 0);
  data.claimed = claimed;
  data.between_nodes = scene.count == 1 ? method::penetration(space, u[0], scene.obstacle.get(), on_mesh.time())
                                        : method::penetration(space, difference(u[0], u[1]), nullptr, on_mesh.time());

  std::vector<double> largest, unbalanced;
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    // D lambda_1 = a(u1, psi) - F1,  D lambda_2 = F2 - a(u2, psi), with (d_t u, psi) beside a(u, psi) in time
    Vector defect(space.map()), inertia(space.map());
    method::apply(*on_mesh.forms()[alpha], u[alpha], defect);
    if (rate[alpha].extent(0) > 0) {
      method::apply(*method::mass(space), rate[alpha], inertia);
      defect.update(1, inertia, 1);
    }
    const double sign = alpha == 0 ? 1 : -1;
    defect.update(-sign, *on_mesh.body()[alpha], sign);
    const auto pressed = at_points(defect, membranes);
    data.equilibrium.push_back(pressed);
    unbalanced.push_back(largest_elsewhere(defect, points));
    largest.push_back(std::max({pressed->normInf(), at_points(on_mesh.force_alone(alpha, Tractions::without), membranes)->normInf(),
                                at_points(inertia, membranes)->normInf()}));
  }
  const PointForces forces = point_forces(solution, largest);
  data.body_scale = forces.on_membrane;
  data.multiplier_scale = forces.through_contact;
  // a gap: the way of the membranes, and what such a force opens at one point
  Vector softness(membranes.points());
  softness.reciprocal(measure.stiffness());
  data.gap_scale = std::max(measure.displacement(x.u), softness.normInf() * forces.through_contact);
  for (int alpha = 0; alpha < scene.count; ++alpha)
    data.gap_scale += measure.round_off_of_height(alpha, x.u) / MembraneMeasure::smallest_digit;
  if (!(data.gap_scale > 0)) data.gap_scale = 1;
  data.of_residual = softness.normInf() / (measure.contact_weight() * data.gap_scale);
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    data.unbalanced = std::max(data.unbalanced, unbalanced[alpha] / data.body_scale[alpha]);
    data.of_residual = std::max(data.of_residual, 1 / (measure.weight(alpha) * data.body_scale[alpha]));
  }
  return data;
}

}  // namespace thixis::membranes
