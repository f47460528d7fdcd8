#include <fmt/format.h>

#include <cmath>

#include "in_time/parabolic_evolution.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::membranes {
namespace {

constexpr double gauss_point = 0.21132486540518711775;  ///< (1 - 1/sqrt 3)/2: the first of two on [0, 1], both of weight 1/2

constexpr double finest = 1e-4;  ///< relative error in time that a method of first order is not asked to fall below

}  // namespace

using algebra::Vector;

complementarity::Estimate ParabolicEvolution::estimate(const Vector& X) {
  if (!bound_) {
    bound_ = make_bound(step_.time.end);
    if (!restored_bound_.empty()) bound_->restore(restored_bound_);
  }
  if (!step_.estimated) {
    if (step_.time.begin == 0) {
      bound_->start(0, step_.before.u, {scene_.initial[0], scene_.initial[1]});
      bounded_ = true;
    }
    bound_->begin(step_.time.begin, step_.time.end, step_.before.u);
    step_.estimated = true;
  }
  const MembraneIterate seen(*on_mesh_, X);
  for (int alpha = 0; alpha < 2; ++alpha) step_.seen.u[alpha] = seen.iterate.u[alpha];
  return (*bound_)(seen.iterate);
}

models::CellEstimates ParabolicEvolution::cell_estimates() const { return bound_ ? cells_of(bound_->cells()) : models::CellEstimates(); }

std::optional<models::StepErrors> ParabolicEvolution::step_errors() const {
  if (!step_.estimated) return std::nullopt;
  const auto errors = bound_->errors();
  const double energy = squared_energy(*on_mesh_, step_.seen);
  return models::StepErrors{errors.time, errors.space, finest * std::sqrt(step_.time.length() * energy)};
}

std::vector<std::string> ParabolicEvolution::doubts() const { return bound_ ? bound_->doubts() : std::vector<std::string>(); }

std::string ParabolicEvolution::remark() const {
  if (!step_.estimated || bound_->resolved()) return {};
  return fmt::format(
      "between t = {:.6g} and {:.6g} a force changes in a way that the rule in time of the bound does not see: the bound takes in what 32 "
      "parts of the step show. Take shorter steps (time/step, time/adaptive), or let one end where data jump (time/also).",
      step_.time.begin, step_.time.end);
}

std::optional<double> ParabolicEvolution::energy_error(const Vector& X) const {
  if (!scene_.exact) return std::nullopt;
  return std::sqrt(step_error(at(X)));
}

std::optional<double> ParabolicEvolution::error_so_far() const {
  if (!scene_.exact) return std::nullopt;
  return std::sqrt(squared_error_);
}

/// Nothing before the first step and after one that was not estimated.
std::optional<complementarity::Estimate> ParabolicEvolution::estimate_so_far() const {
  if (!bounded_ || !bound_) return std::nullopt;
  return bound_->so_far();
}

bool ParabolicEvolution::every_step_estimated() const { return bounded_ || on_mesh_->time() == 0; }

/// ∫ |||u - u_htau|||² over the step, u_htau affine in time: two Gauss points.
double ParabolicEvolution::step_error(const Pair& end) const {
  double sum = 0;
  for (const double s : {gauss_point, 1 - gauss_point}) {
    Pair between;
    for (int alpha = 0; alpha < 2; ++alpha) between.u[alpha] = combination(1 - s, step_.before.u[alpha], s, end.u[alpha]);
    sum += squared_energy_error(*on_mesh_, between, step_.time.begin + s * step_.time.length());
  }
  return step_.time.length() * sum / 2;
}

std::unique_ptr<bound::StepBound> ParabolicEvolution::make_bound(double time) const {
  const core::Region region("estimate set-up");
  auto contact = on_mesh_->contact_problem();
  contact.time = time;
  return std::make_unique<bound::StepBound>(space(), contact, hierarchy_, finest_level(), friedrichs_);
}

}  // namespace thixis::membranes
