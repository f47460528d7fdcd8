#pragma once
#include <array>
#include <vector>

#include "thixis/flow/scene.hpp"
#include "thixis/fv/host.hpp"

namespace thixis::flow {

/// What a scene says of faces on the boundary in a step: states behind them, masses that enter.
struct BoundaryData {
  std::vector<int> of_face;  ///< by local face; -1: nothing
  std::vector<FlowBoundaryKind> kind;
  std::vector<std::array<double, 3>> outside;   ///< s_g, P, chi
  std::vector<std::array<double, 2>> entering;  ///< [kg/(m^2 s)]
};

/// The data of a scene as the verifier asks for them, apart from the solver.
struct SceneData {
  const fv::Grid& grid;
  const fv::HostGrid& on_host;
  const TwoPhaseScene& scene;
  double seconds_per_unit;

  /// Of ]begin, end]: rates at the middle of the step, states at its end.
  BoundaryData boundary(double begin, double end) const;
  /// Water and hydrogen that are made in the owned cells [kg/(m^3 s)].
  std::array<std::vector<double>, 2> sources(double middle) const;
};

}  // namespace thixis::flow
