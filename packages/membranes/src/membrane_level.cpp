#include "membrane_level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "heights.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"
#include "thixis/method/values_at.hpp"

namespace thixis::membranes {
namespace {

using algebra::Vector;
using method::Coefficients;

void check_size(const output::StoredCheckpoint& stored, const std::string& block, GlobalIndex unknowns) {
  const GlobalIndex saved = stored.size(block);
  if (saved == unknowns) return;
  throw core::InputError(
      fmt::format("The checkpoint '{}' belongs to another model, mesh or method: it holds {}, the deck asks for {}; leave scene/model, "
                  "mesh, method and the kinds of the boundary as they were.",
                  stored.path(), saved < 0 ? fmt::format("no '{}'", block) : fmt::format("{} values of '{}'", saved, block), unknowns));
}

/// Brings coefficients together where those of the upper membrane are below those of the lower one, the first ones: at the mean with the
/// weights share and 1 - share.
void keep_in_order(const Coefficients& upper, const Coefficients& lower, const std::vector<double>& share) {
  const Coefficients theta("thixis::membranes::share", share.size());
  const auto host = Kokkos::create_mirror_view(theta);
  std::copy(share.begin(), share.end(), host.data());
  Kokkos::deep_copy(theta, host);
  Kokkos::parallel_for(
      "thixis::membranes::keep_in_order", Kokkos::RangePolicy<>(0, share.size()), KOKKOS_LAMBDA(std::size_t i) {
        if (upper(i) < lower(i)) upper(i) = lower(i) = theta(i) * upper(i) + (1 - theta(i)) * lower(i);
      });
}

std::string displacement(int count, int alpha) { return count == 1 ? "u" : alpha == 0 ? "u1" : "u2"; }

std::vector<double> values_of(const scene::Field& field, const std::vector<models::Probe>& probes) {
  std::vector<double> x, y, values(probes.size());
  for (const auto& probe : probes) {
    x.push_back(probe.at[0]);
    y.push_back(probe.at[1]);
  }
  field.evaluate({probes.size(), x.data(), y.data()}, 0, values.data());
  return values;
}

}  // namespace

MembraneLevel::MembraneLevel(const MembraneScene& scene, double origin, const method::SpaceFactory& make_space,
                             const method::MethodParams& method, const algebra::LinearParams& linear, const mesh::Mesh& mesh)
    : scene_(scene), origin_(origin), method_(method), boundary_(boundary_of(scene, mesh)) {
  space_ = make_space(mesh, {boundary_.dirichlet, scene.interface_level_set, method});
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
  problem_ = std::make_unique<MembraneProblem>(membrane_operator(scene, *space_, lift_, body_), linear, space_->coordinates());
  require_stiffness();
  if (scene.count == 1) obstacle_ = space_->complete(*problem_->membranes().obstacle, lift_of_obstacle());
  measure_from_rest();
}

/// Penalties take a tension for nearly constant in each cell. Where it is not, a function may have negative energy: what shows it on the
/// diagonal is no stiffness, by which anything could be measured.
void MembraneLevel::require_stiffness() const {
  for (int alpha = 0; alpha < scene_.count; ++alpha) {
    double least = std::numeric_limits<double>::infinity();
    {
      const auto diagonal = algebra::host_view(problem_->measure().diagonal(alpha));
      for (std::size_t l = 0; l < diagonal.extent(0); ++l) least = std::min(least, diagonal(l));
    }
    least = space_->mesh().comm.min(least);
    if (least > 0) continue;
    throw core::InputError(
        fmt::format("method/penalty: it is too small for the tension {}, which varies by orders of magnitude inside a cell: an entry of "
                    "the diagonal is {:.2e}; write a larger one, finer cells (mesh/refinements), or another method.",
                    scene_.count == 1 ? "mu" : fmt::format("mu{}", alpha + 1), least));
  }
}

void MembraneLevel::measure_from_rest() {
  const Heights heights = heights_of(scene_, space_->mesh(), time_);
  algebra::MultiVector u(space_->map(), scene_.count);
  for (int alpha = 0; alpha < scene_.count; ++alpha) {
    rest_[alpha] = heights.rest(alpha);
    size_[alpha] = std::max(start_[alpha], heights.size(alpha));
    space_->interpolate(*scene::constant(rest_[alpha]), 0, *u.getVectorNonConst(alpha));
  }
  problem_->measure_from({&u, rest_, size_, scene_.count == 1 ? reach(std::min(heights.low[0], rest_[0])) : 0,
                          [this](int alpha) { return force_alone(alpha).norm2(); }});
}

void MembraneLevel::measure_from(const algebra::MultiVector& u) { problem_->measure_from({&u, rest_, size_, 0, {}}, body_); }

/// A linear solver takes some 14 digits off the residual there, as a norm: at one point what rounding leaves of |u| = (sum_l u_l²)^½ may
/// remain.
void MembraneLevel::start_from(const algebra::MultiVector& u) {
  for (int alpha = 0; alpha < scene_.count; ++alpha) start_[alpha] = u.getVector(alpha)->norm2();
  measure_from_rest();
}

/// (f, psi_l) and tractions, no boundary values among them.
Vector MembraneLevel::force_alone(int alpha) const {
  auto unheld = boundary_.values[alpha];
  for (auto& value : unheld.dirichlet)
    if (value) value = scene::constant(0);
  Vector force(space_->map());
  space_->load(*scene_.tension[alpha], *scene_.force[alpha], unheld, time_, force);
  return force;
}

/// How low forces could bring the membrane, roughly: the sum of all of them over its tension, a length, below where it is held.
double MembraneLevel::reach(double low) const {
  Vector softness(space_->map());
  softness.reciprocal(problem_->measure().diagonal(0));
  return low - 4 * force_alone(0).norm1() * softness.normInf();
}

models::Rounding MembraneLevel::rounding(const Vector& X) const {
  const Fields x = fields(X);
  const MembraneMeasure& measure = problem_->measure();
  const auto lost = measure.rounded_forces(x.u), height = measure.heights(x.u);
  std::array<double, 2> force = {0, 0};
  models::Rounding rounding;
  for (int alpha = 0; alpha < scene_.count; ++alpha) {
    force[alpha] = force_alone(alpha).norm2();
    rounding.height = std::max(rounding.height, height[alpha]);
    if (force[alpha] > 0) rounding.of_forces = std::max(rounding.of_forces, lost[alpha] / force[alpha]);
  }
  const double acting = std::max(measure.on_gap(), measure.on_gap(force));
  if (acting > 0) rounding.of_contact = measure.on_gap(lost) / acting;
  return rounding;
}

void MembraneLevel::set_lifts() {
  for (int alpha = 0; alpha < scene_.count; ++alpha) lift_[alpha] = space_->lift(boundary_.values[alpha], time_);
  // Bernstein coefficients of ordered data need not be ordered
  if (method_.nodes == method::Nodes::bernstein && scene_.count == 2) keep_in_order(lift_[0], lift_[1], share_of_upper_tension());
}

void MembraneLevel::set_loads() {
  for (int alpha = 0; alpha < scene_.count; ++alpha)
    space_->load(*scene_.tension[alpha], *scene_.force[alpha], boundary_.values[alpha], time_, *body_[alpha]);
}

void MembraneLevel::move_to(double t) {
  if (t == time_) return;
  time_ = t;
  if (!steady_interface_) space_->move_interface(t);
  if (!steady_boundary_) {
    check_boundary(scene_, boundary_, method_, space_->mesh(), t);
    set_lifts();
  }
  if (!steady_loads_) set_loads();
}

Teuchos::RCP<Vector> MembraneLevel::from_coarse(const MembraneLevel& coarse, const Vector& coarse_X) const {
  Vector settled(coarse_X, Teuchos::Copy);
  coarse.problem_->settle(settled);
  const Fields coarse_x = coarse.fields(settled);
  const auto X = zero();
  Fields x = fields(*X);
  for (int alpha = 0; alpha < scene_.count; ++alpha) {
    Coefficients u = coarse.membrane(coarse_x, alpha);
    if (scene_.count == 1) u = difference(u, coarse.obstacle_);  // the gap: where it is closed it stays so
    space_->prolongate(*coarse.space_, u, *x.u.getVectorNonConst(alpha));
  }
  if (scene_.count == 1) x.u.update(1, *problem_->membranes().obstacle, 1);
  space_->prolongate_multiplier(*coarse.space_, coarse_x.lambda, x.lambda);
  return X;
}

std::vector<output::CheckpointBlock> MembraneLevel::save(const Vector& X, const std::string& suffix) const {
  const Fields x = fields(X);
  std::vector<output::CheckpointBlock> blocks;
  const auto ids = space_->unknown_ids();
  const auto add = [&](const std::string& name, const Vector& v) {
    const auto values = algebra::host_view(v);
    const auto count = static_cast<std::ptrdiff_t>(values.extent(0));
    blocks.push_back({name + suffix, {ids.begin(), ids.begin() + count}, {values.data(), values.data() + count}});
  };
  for (int alpha = 0; alpha < scene_.count; ++alpha) add(displacement(scene_.count, alpha), *x.u.getVector(alpha));
  add("lambda", x.lambda);
  if (origin_ != 0) {
    const bool root = space_->mesh().comm.root();
    blocks.push_back({"origin" + suffix, root ? std::vector<GlobalIndex>{0} : std::vector<GlobalIndex>{},
                      root ? std::vector<double>{origin_} : std::vector<double>{}});
  }
  return blocks;
}

Teuchos::RCP<Vector> MembraneLevel::restore(const output::StoredCheckpoint& stored, const std::string& suffix) const {
  const auto X = zero();
  Fields x = fields(*X);
  const auto ids = space_->unknown_ids();
  const auto fetch = [&](const std::string& name, Vector& v) {
    check_size(stored, name + suffix, static_cast<GlobalIndex>(v.getGlobalLength()));
    const auto values = stored.fetch_finite(name + suffix, {ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(v.getLocalLength())});
    const auto out = algebra::host_overwrite(v);
    std::copy(values.begin(), values.end(), out.data());
  };
  for (int alpha = 0; alpha < scene_.count; ++alpha) fetch(displacement(scene_.count, alpha), *x.u.getVectorNonConst(alpha));
  fetch("lambda", x.lambda);
  const double origin = stored.size("origin" + suffix) < 0 ? 0 : stored.fetch_finite("origin" + suffix, {0}).front();
  if (origin != origin_) {
    Vector by(space_->map());
    space_->interpolate(*scene::constant(origin - origin_), 0, by);
    for (int alpha = 0; alpha < scene_.count; ++alpha) x.u.getVectorNonConst(alpha)->update(1, by, 1);
  }
  return X;
}

std::vector<output::FieldData> MembraneLevel::shown(const Vector& X, const complementarity::ActiveSet& active,
                                                    const std::vector<std::string>& names) const {
  const Fields x = fields(X);
  std::vector<output::FieldData> shown;
  const auto add = [&](const std::string& name, auto values) {
    if (names.empty() || std::find(names.begin(), names.end(), name) != names.end())
      shown.push_back({name, output::Centre::vertex, values()});
  };
  for (int alpha = 0; alpha < scene_.count; ++alpha)
    add(displacement(scene_.count, alpha), [&] {
      auto heights = space_->shown(membrane(x, alpha));
      for (double& height : heights) height += origin_;
      return heights;
    });
  add("lambda", [&] { return space_->shown(space_->multiplier(x.lambda)); });
  add("gap", [&] {
    auto gap = space_->shown(membrane(x, 0));
    const auto below = scene_.count == 2 ? space_->shown(membrane(x, 1)) : at_points(*scene_.obstacle);
    for (std::size_t i = 0; i < gap.size(); ++i) gap[i] -= below[i];
    return gap;
  });
  add("active", [&] {
    Vector flag(space_->map());
    {
      const auto out = algebra::host_view(flag);
      for (std::size_t l = 0; l < active.flags().size(); ++l) out(l) = active.flags()[l];
    }
    return space_->coefficients_shown(space_->complete(flag, nothing_));
  });
  return shown;
}

std::vector<std::string> MembraneLevel::point_fields(const MembraneScene& scene) {
  std::vector<std::string> names;
  for (int alpha = 0; alpha < scene.count; ++alpha) names.push_back(displacement(scene.count, alpha));
  names.insert(names.end(), {"lambda", "gap"});
  return names;
}

std::vector<double> MembraneLevel::values_at(const std::vector<models::Probe>& probes, const Vector& X) const {
  const Fields x = fields(X);
  const auto places = place(probes, space_->mesh());
  std::vector<std::vector<double>> columns;
  for (int alpha = 0; alpha < scene_.count; ++alpha) columns.push_back(method::values_at(polynomials(), places, membrane(x, alpha)));
  columns.push_back(method::values_at(polynomials(), places, space_->multiplier(x.lambda)));
  columns.push_back(columns[0]);
  const auto below = scene_.count == 2 ? columns[1] : values_of(*scene_.obstacle, probes);
  for (std::size_t i = 0; i < probes.size(); ++i) columns.back()[i] -= below[i];
  for (int alpha = 0; alpha < scene_.count; ++alpha)
    for (double& height : columns[alpha]) height += origin_;
  std::vector<double> rows;
  for (std::size_t i = 0; i < probes.size(); ++i)
    for (const auto& column : columns) rows.push_back(column[i]);
  return rows;
}

Vector MembraneLevel::gaps(const Fields& x) const {
  Vector K(problem_->points());
  gap(problem_->membranes(), x.u, K);
  return K;
}

double MembraneLevel::largest_gap(const Vector& X) const {
  const Vector gaps_l = gaps(fields(X));
  const auto K = algebra::host_view(gaps_l);
  double largest = 0;
  for (std::size_t l = 0; l < K.extent(0); ++l) largest = std::max(largest, K(l));
  return space_->mesh().comm.max(largest);
}

models::Contact MembraneLevel::contact(const Vector& X) const {
  const Fields x = fields(X);
  const Vector gaps_l = gaps(x);
  Vector scale(problem_->points());
  problem_->scaling(scale);
  models::Contact sum;
  {
    const auto read = [](const Vector& v) { return algebra::host_view(v); };
    const auto weight = read(areas()), K = read(gaps_l), s = read(scale), lambda = read(x.lambda), D = read(space_->pairing());
    for (std::size_t l = 0; l < K.extent(0); ++l) {
      if (s(l) * lambda(l) > K(l)) sum.area += weight(l);
      sum.force += D(l) * lambda(l);
    }
  }
  const core::Comm& comm = space_->mesh().comm;
  return {comm.sum(sum.area), comm.sum(sum.force)};
}

/// Set up at the first call. Collective.
const Vector& MembraneLevel::areas() const {
  if (areas_.is_null()) {
    const std::vector<scene::FieldPtr> zero(space_->mesh().tags.size(), scene::constant(0));
    const auto one = scene::constant(1);
    areas_ = Teuchos::rcp(new Vector(space_->map()));
    space_->load(*one, *one, {zero, zero}, 0, *areas_);
  }
  return *areas_;
}

bound::ContactProblem MembraneLevel::contact_problem() const {
  bound::ContactProblem contact;
  contact.count = scene_.count;
  contact.obstacle = scene_.obstacle;
  contact.interface = scene_.interface_level_set;
  for (int alpha = 0; alpha < scene_.count; ++alpha) {
    contact.tension[alpha] = scene_.tension[alpha];
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

/// Values at the points of the grid.
std::vector<double> MembraneLevel::at_points(const scene::Field& field) const {
  const auto points = space_->display().points;
  std::vector<double> x, y, values(points.size());
  for (const auto& point : points) {
    x.push_back(point[0]);
    y.push_back(point[1]);
  }
  space_->mesh().comm.together([&] { field.evaluate({points.size(), x.data(), y.data()}, 0, values.data()); });
  return values;
}

/// mu_1 / (mu_1 + mu_2) at the points of the grid: the stiffer membrane gives way less.
std::vector<double> MembraneLevel::share_of_upper_tension() const {
  auto share = at_points(*scene_.tension[0]);
  const auto lower = at_points(*scene_.tension[1]);
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double both = share[i] + lower[i];
    share[i] = both > 0 ? std::clamp(share[i] / both, 0.0, 1.0) : 0.5;
  }
  return share;
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
