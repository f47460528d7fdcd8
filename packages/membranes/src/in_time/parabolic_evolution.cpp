#include "in_time/parabolic_evolution.hpp"

#include <fmt/format.h>

#include <cmath>

#include "checks/membrane_checks.hpp"
#include "scene/heights.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/method/measures.hpp"

namespace thixis::membranes {

using algebra::Vector;
using method::Coefficients;

Coefficients combination(double a, const Coefficients& u, double b, const Coefficients& v) {
  const Coefficients w("thixis::membranes::combination", u.extent(0));
  Kokkos::parallel_for(
      "thixis::membranes::combination", Kokkos::RangePolicy<>(0, u.extent_int(0)), KOKKOS_LAMBDA(int i) { w(i) = a * u(i) + b * v(i); });
  return w;
}

ParabolicEvolution::ParabolicEvolution(const MembraneScene& scene, const method::Method& by, const method::MethodParams& method,
                                       const algebra::LinearParams& linear, mesh::Hierarchy hierarchy, std::optional<double> friedrichs,
                                       std::vector<models::Probe> probes)
    : origin_(heights_of(scene, hierarchy.levels.front(), 0).origin()),
      scene_(counted_from(origin_, scene)),
      linear_(linear),
      hierarchy_(std::move(hierarchy)),
      levels_(levels_of(scene_, by, method, hierarchy_)),
      friedrichs_(friedrichs),
      probes_(std::move(probes)) {
  on_mesh_ = make_level();
}

Teuchos::RCP<Vector> ParabolicEvolution::initial() {
  on_mesh_->move_to(0);
  auto X = on_mesh_->zero();
  Fields x = on_mesh_->fields(*X);
  for (int alpha = 0; alpha < 2; ++alpha) space().interpolate(*scene_.initial[alpha], 0, *x.u.getVectorNonConst(alpha));
  return X;
}

void ParabolicEvolution::check(const std::vector<double>& times) const {
  if (steady_boundary(scene_)) return;
  for (const double t : times) check_boundary(scene_, on_mesh_->boundary(), space().options().params, space().mesh(), t);
}

void ParabolicEvolution::begin(const models::TimeStep& step, const Vector& before) {
  const core::Region region("assembly");
  step_.time = step;
  step_.estimated = false;
  standing_ = Standing::opening;
  on_mesh_->move_to(step.begin);
  step_.before = at(before);
  on_mesh_->move_to(step.end);
  if (const double rate = scheme_.rate(step.length()); rate != rate_) {
    rate_ = rate;
    on_mesh_->problem().set_inertia(space(), rate_);
  }
  set_loads();
  on_mesh_->measure_from(on_mesh_->fields(before).u);
  step_.X = Teuchos::rcp(new Vector(before, Teuchos::Copy));
  standing_ = Standing::in_step;
}

/// F_alpha <- (f_alpha, psi) + rate (u_alpha^{n-1}, psi) - a_alpha(g, psi) - rate (g, psi) with the lift g of the boundary values.
void ParabolicEvolution::set_loads() {
  Vector part(space().map());
  for (int alpha = 0; alpha < 2; ++alpha) {
    const auto F = on_mesh_->problem().membranes().system.load->getVectorNonConst(alpha);
    method::apply(*method::mass(space()), combination(rate_, step_.before.u[alpha], -rate_, on_mesh_->lift(alpha)), part);
    F->update(1, *on_mesh_->body()[alpha], 1, part, 0);
    method::apply(*on_mesh_->forms()[alpha], on_mesh_->lift(alpha), part);
    F->update(-1, part, 1);
  }
}

/// X^{n-1} + ratio (X^{n-1} - X^{n-2}), made complementary point by point.
bool ParabolicEvolution::predict(Vector& X) {
  if (last_.X.is_null()) return false;
  const double ratio = step_.time.length() / last_.length;
  X.update(1 + ratio, *step_.X, -ratio, *last_.X, 0);
  on_mesh_->problem().make_admissible(*step_.X, X);
  return true;
}

void ParabolicEvolution::give_up() {
  if (step_is_open()) on_mesh_->move_to(step_.time.begin);
  standing_ = Standing::at_rest;
  step_.estimated = false;
}

void ParabolicEvolution::accept(const Vector& X) {
  if (scene_.exact) squared_error_ += step_error(at(X));
  if (step_.estimated) bound_->accept();
  else bounded_ = false;
  last_ = {step_.X, step_.time.length()};
  standing_ = Standing::at_end;
}

/// At X^0, and where a run is taken up again, the equations say nothing: the multiplier is judged by its sign alone.
complementarity::KktData ParabolicEvolution::kkt_data(const Vector& X) const {
  MembraneSolution now = solution(X);
  if (step_is_known())
    for (int alpha = 0; alpha < 2; ++alpha) now.rate[alpha] = combination(rate_, now.u[alpha], -rate_, step_.before.u[alpha]);
  auto data = membranes::kkt_data(now);
  if (!step_is_known()) {
    data.equilibrium = {data.claimed};
    data.unbalanced = 0;
  }
  return data;
}

std::vector<std::string> ParabolicEvolution::series_names() const {
  std::vector<std::string> names = {"contact_area", "contact_force", "largest_gap"};
  if (scene_.exact) names.insert(names.end(), {"energy_error", "l2_error_u1", "l2_error_u2"});
  for (std::size_t i = 0; i < probes_.size(); ++i)
    for (const auto& field : MembraneLevel::point_fields(scene_)) names.push_back(i == 0 ? field : fmt::format("{}_{}", field, i + 1));
  return names;
}

/// (contact area and force, max_l gap_l; of the errors at this time the energy norm and the L² norms; the fields at the probes).
std::vector<double> ParabolicEvolution::series(const Vector& X) const {
  const models::Contact contact = on_mesh_->contact(X);
  std::vector<double> values = {contact.area, contact.force, on_mesh_->largest_gap(X)};
  if (scene_.exact) {
    const Pair now = at(X);
    const double t = on_mesh_->time();
    values.push_back(std::sqrt(squared_energy_error(*on_mesh_, now, t)));
    for (int alpha = 0; alpha < 2; ++alpha) values.push_back(std::sqrt(method::l2_error(space(), now.u[alpha], scene_.exact->u[alpha], t)));
  }
  if (!probes_.empty())
    for (const double value : on_mesh_->values_at(probes_, X)) values.push_back(value);
  return values;
}

}  // namespace thixis::membranes
