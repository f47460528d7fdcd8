#include "look/look.hpp"

#include <cmath>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {

complementarity::Estimate Look::operator()(models::SceneOnMesh& scene, const algebra::Vector& X) {
  const auto estimate = scene.estimate(X);
  const core::Region region("verification");
  if (output_.history) error_ = scene.energy_error(X);
  return estimate;
}

std::optional<complementarity::Estimate> estimate_at_end(models::SceneOnMesh& scene, const complementarity::NewtonReport& newton,
                                                         const algebra::Vector& X) {
  if (newton.estimate) return newton.estimate;
  if (!std::isfinite(algebra::norm2(X))) return std::nullopt;
  const core::Region region("estimate");
  return scene.estimate(X);
}

double kkt_tolerance(models::SceneOnMesh& scene, const complementarity::StoppingParams& stopping, const complementarity::KktData& data,
                     const algebra::Vector& X, double round_off) {
  const complementarity::Problem& problem = scene.problem();
  const double residual = stopping.nonlinear_residual(problem.reference_norm(), round_off + problem.noise(X));
  return stopping.kkt_tolerance.value_or(data.allowed(residual));
}

}  // namespace thixis::drive
