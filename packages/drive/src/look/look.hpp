#pragma once
#include "thixis/complementarity/newton.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/models/scene_on_mesh.hpp"

namespace thixis::drive {

/// What a run sees of the error at iterates.
class Look {
 public:
  explicit Look(const OutputParams& output) : output_(output) {}

  /// The estimate at an iterate, and for the history its error. Collective.
  complementarity::Estimate operator()(models::SceneOnMesh& scene, const algebra::Vector& X);
  /// The error where the estimate was asked for last; for records that have one.
  std::optional<double> error(const std::optional<complementarity::Estimate>& of_record) const { return of_record ? error_ : std::nullopt; }

 private:
  const OutputParams& output_;
  std::optional<double> error_;
};

/// The estimate where Newton's method has ended: the one that it has asked for, or else a new one. Nothing where X is not finite.
/// Collective.
std::optional<complementarity::Estimate> estimate_at_end(models::SceneOnMesh& scene, const complementarity::NewtonReport& newton,
                                                         const algebra::Vector& X);

/// What the verifier lets pass: stopping/kkt tolerance, or what `data` allow for the tolerance of the nonlinear solver at X. `round_off`:
/// to what rounding lets the residual fall, beside the noise of the problem.
double kkt_tolerance(models::SceneOnMesh& scene, const complementarity::StoppingParams& stopping, const complementarity::KktData& data,
                     const algebra::Vector& X, double round_off = 0);

}  // namespace thixis::drive
