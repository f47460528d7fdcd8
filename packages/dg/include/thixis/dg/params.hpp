#pragma once
#include "thixis/core/schema.hpp"

namespace thixis::dg {

/// theta = 1 or -1 in A_h.
enum class Variant { sipg, nipg };
/// How Dirichlet data are taken: by the forms on the boundary, or by fixed nodes.
enum class BoundaryTreatment { weak, strong };

/// What dG has in the block `method` for itself: MethodParams::own.
struct Params {
  Variant variant = Variant::sipg;
  double penalty = 10;  ///< eta in eta p²/|F|
  BoundaryTreatment boundary = BoundaryTreatment::weak;
  static const core::Schema<Params>& schema();
};

}  // namespace thixis::dg
