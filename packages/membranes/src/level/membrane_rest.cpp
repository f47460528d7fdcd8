#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "level/membrane_level.hpp"
#include "scene/heights.hpp"
#include "thixis/core/error.hpp"

namespace thixis::membranes {

using algebra::Vector;

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
                          [this](int alpha) { return force_alone(alpha, Tractions::with).norm2(); }});
}

void MembraneLevel::measure_from(const algebra::MultiVector& u) { problem_->measure_from({&u, rest_, size_, 0, {}}, body_); }

/// A linear solver takes some 14 digits off the residual there, as a norm: at one point what rounding leaves of |u| = (sum_l u_l²)^½ may
/// remain.
void MembraneLevel::start_from(const algebra::MultiVector& u) {
  for (int alpha = 0; alpha < scene_.count; ++alpha) start_[alpha] = u.getVector(alpha)->norm2();
  measure_from_rest();
}

Vector MembraneLevel::force_alone(int alpha, Tractions tractions) const {
  Vector force(space_->map());
  space_->mesh().comm.together([&] {
    space_->add_moments(*scene_.force[alpha], time_, force);
    if (tractions == Tractions::with) space_->add_traces(boundary_.values[alpha].neumann, time_, force);
  });
  return force;
}

/// How low forces could bring the membrane, roughly: the sum of all of them over its tension, a length, below where it is held.
double MembraneLevel::reach(double low) const {
  Vector softness(space_->map());
  softness.reciprocal(problem_->measure().diagonal(0));
  return low - 4 * force_alone(0, Tractions::with).norm1() * softness.normInf();
}

models::Rounding MembraneLevel::rounding(const Vector& X) const {
  const Fields x = fields(X);
  const MembraneMeasure& measure = problem_->measure();
  const auto lost = measure.rounded_forces(x.u), height = measure.heights(x.u);
  std::array<double, 2> force = {0, 0};
  models::Rounding rounding;
  for (int alpha = 0; alpha < scene_.count; ++alpha) {
    force[alpha] = force_alone(alpha, Tractions::with).norm2();
    rounding.height = std::max(rounding.height, height[alpha]);
    if (force[alpha] > 0) rounding.of_forces = std::max(rounding.of_forces, lost[alpha] / force[alpha]);
  }
  const double acting = std::max(measure.on_gap(), measure.on_gap(force));
  if (acting > 0) rounding.of_contact = measure.on_gap(lost) / acting;
  return rounding;
}

}  // namespace thixis::membranes
