#include "membrane_kkt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::models {
namespace {

using algebra::Vector;
using method::Coefficients;

struct Extent {
  double width = 0;  ///< diagonal of the box around the mesh
  double area = 0;
};

/// Collective.
Extent extent_of(const mesh::Mesh& mesh) {
  const auto x = mesh::on_host(mesh).coordinates;
  double box[4] = {-1e300, -1e300, -1e300, -1e300};  // -lower, upper
  for (LocalIndex v = 0; v < mesh.vertices; ++v)
    for (int d = 0; d < 2; ++d) {
      box[d] = std::max(box[d], -x(v, d));
      box[2 + d] = std::max(box[2 + d], x(v, d));
    }
  for (double& side : box) side = mesh.comm.max(side);
  double area = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) area += mesh::cell_area(mesh.coordinates, mesh.cell_vertices, K);
  return {std::hypot(box[2] + box[0], box[3] + box[1]), mesh.comm.sum(area)};
}

/// Largest absolute value. Collective.
double largest(const Coefficients& u, const core::Comm& comm) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  double value = 0;
  for (std::size_t i = 0; i < host.extent(0); ++i) value = std::max(value, std::abs(host(i)));
  return comm.max(value);
}

/// v / D at the contact points.
Teuchos::RCP<Vector> over_pairing(const Vector& v, const Vector& pairing) {
  auto quotient = Teuchos::rcp(new Vector(pairing.getMap()));
  const auto in = algebra::host_view(v), D = algebra::host_view(pairing);
  const auto out = algebra::host_overwrite(*quotient);
  for (std::size_t l = 0; l < out.extent(0); ++l) out(l) = in(l) / D(l);
  return quotient;
}

/// Largest tension at the vertices. Collective.
double largest_tension(const scene::Field& tension, const mesh::Mesh& mesh) {
  if (const double* constant = tension.constant()) return *constant;
  const auto host = mesh::on_host(mesh);
  const auto count = static_cast<std::size_t>(mesh.vertices);
  std::vector<double> x(count), y(count), mu(count);
  for (std::size_t v = 0; v < count; ++v) {
    x[v] = host.coordinates(v, 0);
    y[v] = host.coordinates(v, 1);
  }
  mesh.comm.together([&] { tension.evaluate({count, x.data(), y.data()}, 0, mu.data()); });
  return mesh.comm.max(count > 0 ? *std::max_element(mu.begin(), mu.end()) : 0.0);
}

/// Largest |v_l| at nodes that are no contact points. Collective.
double largest_elsewhere(const Vector& v, LocalIndex points) {
  const auto values = algebra::host_view(v);
  double value = 0;
  for (std::size_t l = points; l < values.extent(0); ++l) value = std::max(value, std::abs(values(l)));
  return algebra::comm_of(*v.getMap()).max(value);
}

/// (f, psi_l), no boundary data among it.
Vector force_alone(const MembraneSolution& solution, int alpha) {
  const std::vector<scene::FieldPtr> zero(solution.space.mesh().tags.size(), scene::constant(0));
  Vector F(solution.space.map());
  solution.space.load(*solution.scene.tension[alpha], *solution.scene.force[alpha], {zero, zero}, solution.t, F);
  return F;
}

}  // namespace

complementarity::KktData kkt_data(const MembraneSolution& solution) {
  const auto& [scene, space, problem, body, x, u, t, rate] = solution;
  const MembraneOperator& membranes = problem.membranes();
  const Vector& D = space.pairing();
  complementarity::KktData data;
  auto gap_l = Teuchos::rcp(new Vector(membranes.points()));
  gap(membranes, x.u, *gap_l);
  data.gap = gap_l;
  data.claimed = Teuchos::rcp(new Vector(x.lambda, Teuchos::Copy));
  data.between_nodes =
      scene.count == 1 ? space.penetration(u[0], scene.obstacle.get(), t) : space.penetration(difference(u[0], u[1]), nullptr, t);

  const Extent domain = extent_of(space.mesh());
  const auto points = static_cast<double>(std::max<std::size_t>(membranes.points()->getGlobalNumElements(), 1));
  const double mean_pairing = membranes.points()->getGlobalNumElements() > 0 ? D.meanValue() : 1;
  const double per_area =
      domain.area / points / mean_pairing;  // of X3: about 1 for nodal values, |K| over the points of a cell for moments
  double size = 0, softest = std::numeric_limits<double>::infinity();
  data.multiplier_scale = 0;
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    // lambda_1 = (a(u1, psi) - F1) / D,  lambda_2 = (F2 - a(u2, psi)) / D, with (d_t u, psi) beside a(u, psi) in time
    Vector defect(space.map()), inertia(space.map());
    space.forces(*scene.tension[alpha], u[alpha], defect);
    if (rate[alpha].extent(0) > 0) {
      space.apply_mass(rate[alpha], inertia);
      defect.update(1, inertia, 1);
    }
    const double sign = alpha == 0 ? 1 : -1;
    defect.update(-sign, *body[alpha], sign);
    const auto multiplier = over_pairing(defect, D);
    data.equilibrium.push_back(multiplier);
    data.unbalanced = std::max(data.unbalanced, largest_elsewhere(defect, algebra::local_size(*membranes.points())) / mean_pairing);
    // what is large: the force per area that is there, …
    data.multiplier_scale = std::max({data.multiplier_scale, multiplier->normInf(),
                                      over_pairing(force_alone(solution, alpha), D)->normInf(), over_pairing(inertia, D)->normInf()});
    softest = std::min(softest, largest_tension(*scene.tension[alpha], space.mesh()));
    size = std::max(size, largest(u[alpha], space.mesh().comm));
  }
  // … and the one that bends the softer membrane to such heights over the width of the domain
  data.multiplier_scale = std::max(data.multiplier_scale, softest * size / (domain.width * domain.width) * per_area);
  if (!(data.multiplier_scale > 0)) data.multiplier_scale = 1;
  // … and a gap: the heights that are there, and what such a force opens at one point
  Vector s(membranes.points());
  problem.scaling(s);
  Vector inverse_D(membranes.points()), inverse_s(membranes.points());
  inverse_D.reciprocal(D);
  inverse_s.reciprocal(s);
  data.smallest_weight = 1 / std::max(inverse_D.normInf(), inverse_s.normInf());
  data.gap_scale = std::max(size, s.normInf() * data.multiplier_scale);
  if (!(data.gap_scale > 0)) data.gap_scale = 1;
  return data;
}

}  // namespace thixis::models
