#include "level/membrane_level.hpp"

#include <algorithm>

#include "checks/membrane_checks.hpp"
#include "thixis/bound/shares.hpp"
#include "thixis/core/assert.hpp"

namespace thixis::membranes {
namespace {

using algebra::Vector;
using method::Coefficients;

/// Brings coefficients together where those of the upper membrane are below those of the lower one, the first ones: the upper one goes so
/// much of the way.
void keep_in_order(const Coefficients& upper, const Coefficients& lower, const std::vector<double>& way) {
  const Coefficients of_upper("thixis::membranes::way", way.size());
  const auto host = Kokkos::create_mirror_view(of_upper);
  std::copy(way.begin(), way.end(), host.data());
  Kokkos::deep_copy(of_upper, host);
  Kokkos::parallel_for(
      "thixis::membranes::keep_in_order", Kokkos::RangePolicy<>(0, way.size()), KOKKOS_LAMBDA(std::size_t i) {
        if (upper(i) < lower(i)) upper(i) = lower(i) = (1 - of_upper(i)) * upper(i) + of_upper(i) * lower(i);
      });
}

}  // namespace

std::shared_ptr<method::Levels> levels_of(const MembraneScene& scene, const method::Method& by, const method::MethodParams& method,
                                          const mesh::Hierarchy& hierarchy) {
  return std::make_shared<method::Levels>(hierarchy, by, [&scene, method](const mesh::Mesh& mesh) {
    return method::SpaceOptions{boundary_of(scene, mesh).dirichlet, scene.interface_level_set, method};
  });
}

MembraneLevel::MembraneLevel(const MembraneScene& scene, double origin, const std::shared_ptr<method::Levels>& levels, int level,
                             const algebra::LinearParams& linear)
    : scene_(scene),
      origin_(origin),
      levels_(levels),
      level_(level),
      space_(levels->space(level)),
      boundary_(boundary_of(scene, space_->mesh())) {
  for (int alpha = 0; alpha < scene.count; ++alpha) form_[alpha] = levels->diffusion(level, scene.tension[alpha]);
  steady_interface_ = steady({scene.interface_level_set});
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    const auto& [dirichlet, neumann] = boundary_.values[alpha];
    steady_boundary_ = steady_boundary_ && steady(dirichlet);
    steady_loads_ = steady_loads_ && steady(dirichlet) && steady(neumann) && steady({scene.force[alpha]});
    body_[alpha] = Teuchos::rcp(new Vector(space_->map()));
  }
  steady_loads_ = steady_loads_ && steady_interface_;
  set_lifts();
  nothing_ = Coefficients("thixis::membranes::nothing", lift_[0].extent(0));
  set_loads();
  const bool multigrid = linear.solver != algebra::SolverKind::direct && linear.preconditioner == algebra::PreconditionerKind::multigrid;
  const algebra::Nodes nodes{space_->coordinates(), multigrid ? levels->below(level) : algebra::Nodes{}.below};
  problem_ = std::make_unique<MembraneProblem>(membrane_operator(scene, levels->method(), form_, lift_, body_), linear, nodes);
  require_stiffness();
  if (scene.count == 1) obstacle_ = space_->complete(*problem_->membranes().obstacle, lift_of_obstacle());
  measure_from_rest();
}

void MembraneLevel::set_lifts() {
  for (int alpha = 0; alpha < scene_.count; ++alpha) lift_[alpha] = space_->lift(boundary_.values[alpha], time_);
  // Bernstein coefficients of ordered data need not be ordered
  if (space_->options().params.nodes == method::Nodes::bernstein && scene_.count == 2)
    keep_in_order(lift_[0], lift_[1], space_->mesh().comm.together([&] {
      const PointList at = grid_points();
      return bound::ways_of_upper({scene_.tension[0], scene_.tension[1]}, at.x, at.y);
    }));
}

void MembraneLevel::set_loads() {
  for (int alpha = 0; alpha < scene_.count; ++alpha)
    method::load(*form_[alpha], *scene_.force[alpha], boundary_.values[alpha], time_, *body_[alpha]);
}

void MembraneLevel::move_to(double t) {
  if (t == time_) return;
  time_ = t;
  if (!steady_interface_) space_->move_interface(t);
  if (!steady_boundary_) {
    check_boundary(scene_, boundary_, space_->options().params, space_->mesh(), t);
    set_lifts();
  }
  if (!steady_loads_) set_loads();
}

Teuchos::RCP<Vector> MembraneLevel::from_coarse(const MembraneLevel& coarse, const Vector& coarse_X) const {
  THIXIS_ASSERT_EQ(coarse.level_, level_ - 1, "a start comes from the level before");
  Vector settled(coarse_X, Teuchos::Copy);
  coarse.problem_->settle(settled);
  const Fields coarse_x = coarse.fields(settled);
  const method::Transfer& P = levels_->transfer(level_);
  const auto X = zero();
  Fields x = fields(*X);
  for (int alpha = 0; alpha < scene_.count; ++alpha) {
    Coefficients u = coarse.membrane(coarse_x, alpha);
    if (scene_.count == 1) u = difference(u, coarse.obstacle_);  // the gap: where it is closed it stays so
    P.prolongate(u, *x.u.getVectorNonConst(alpha));
  }
  if (scene_.count == 1) x.u.update(1, *problem_->membranes().obstacle, 1);
  P.multiplier(coarse_x.lambda, x.lambda);
  return X;
}

bound::ContactProblem MembraneLevel::contact_problem() const {
  bound::ContactProblem contact;
  contact.count = scene_.count;
  contact.obstacle = scene_.obstacle;
  contact.interface = scene_.interface_level_set;
  for (int alpha = 0; alpha < scene_.count; ++alpha) {
    contact.tension[alpha] = scene_.tension[alpha];
    contact.form[alpha] = form_[alpha];
    contact.force[alpha] = scene_.force[alpha];
    contact.boundary[alpha] = boundary_.values[alpha];
  }
  return contact;
}

Coefficients MembraneLevel::lift_of_obstacle() const {
  method::BoundaryValues psi = boundary_.values[0];
  for (auto& value : psi.dirichlet)
    if (value) value = scene_.obstacle;
  return space_->lift(psi, 0);
}

/// Those of Space::display.
PointList MembraneLevel::grid_points() const {
  PointList points;
  for (const auto& point : space_->display().points) points.add(point[0], point[1]);
  return points;
}

MembraneIterate::MembraneIterate(const MembraneLevel& of, const Vector& X)
    : minus_R(of.problem().map()), x(of.fields(X)), r(of.fields(minus_R)), gap_l(of.problem().points()) {
  of.problem().equations(X, minus_R);
  minus_R.scale(-1);
  gap(of.problem().membranes(), x.u, gap_l);
  iterate.lambda = &x.lambda;
  iterate.gap = &gap_l;
  for (int alpha = 0; alpha < of.count(); ++alpha) {
    iterate.u[alpha] = of.membrane(x, alpha);
    residual[alpha] = r.u.getVector(alpha);
    iterate.residual[alpha] = residual[alpha].get();
  }
}

}  // namespace thixis::membranes
