#pragma once
#include <optional>
#include <string>
#include <vector>

#include "thixis/algebra/solver.hpp"
#include "thixis/complementarity/parameters.hpp"
#include "thixis/core/schema.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/method/space.hpp"
#include "thixis/scene/membranes.hpp"

namespace thixis::drive {

/// Block `output` of the deck.
struct OutputParams {
  std::string directory;       ///< empty: results/<name of the deck>
  std::string fields = "all";  ///< all, none, or names separated by commas
  bool history = true;
  int checkpoint_every = 0;  ///< Newton steps (stationary scenes); 0: only where a run does not converge
  static const core::Schema<OutputParams>& schema();
  /// The names in `fields`; nothing for `all`. `none` is asked for by `no_fields`.
  std::vector<std::string> field_names() const;
  bool no_fields() const { return fields == "none"; }
};

/// Block `expect` of the deck: what the run checks of its own result (exit code 4 if it does not hold).
struct ExpectParams {
  std::optional<double> energy_error_at_most;
  std::optional<std::vector<double>> energy_error_between;
  std::optional<int> newton_iterations_at_most, newton_finest_at_most, linear_iterations_at_most;
  std::optional<double> kkt_at_most;
  std::optional<std::vector<double>> effectivity_between;
  std::optional<long long> unknowns, cells;
  static const core::Schema<ExpectParams>& schema();
};

/// The whole deck.
struct RunParams {
  scene::SceneParams scene;
  mesh::MeshParams mesh;
  method::MethodParams method;
  complementarity::NewtonParams newton;
  algebra::LinearParams linear;
  complementarity::StoppingParams stopping;
  OutputParams output;
  ExpectParams expect;
  static const core::Schema<RunParams>& schema();
};

}  // namespace thixis::drive
