#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "thixis/complementarity/newton.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/models/model.hpp"

namespace thixis::drive {

/// One row of the history; what was not computed is empty.
struct Progress {
  int level = 0;
  std::optional<int> newton, linear;
  std::optional<long long> active, changed;
  std::optional<double> residual, energy_error;
};

/// Who follows a solve; functions may be empty.
struct Observer {
  std::function<void(const mesh::Mesh& mesh, int level, const models::Sizes& sizes)> level;
  std::function<void(const Progress&, const complementarity::NewtonRecord&)> step;
  std::function<void(const Progress&)> check;
  std::function<void(const std::string&)> message;
};

/// The solution on the finest level reached, and what it took.
struct Outcome {
  const mesh::Mesh* mesh = nullptr;
  std::unique_ptr<models::Discretization> discretization;
  Teuchos::RCP<algebra::Vector> X;
  bool solved = false;
  bool not_wanted = false;  ///< max iterations = 0: only counted
  complementarity::NewtonReport finest;
  int newton_iterations = 0, linear_iterations = 0;  ///< on all levels
  std::optional<complementarity::Kkt> kkt;
  double kkt_tolerance = 0;  ///< what the verifier lets pass
  std::optional<double> energy_error;
  double energy_norm = 0;
};

/// Solves a stationary scene: on the finest mesh from a cold start, or (newton/start = nested) on all meshes, coarsest first, each from the
/// solution on the mesh before. Keeps the last iterate where Newton does not converge.
Outcome solve_stationary(const models::Model& model, const mesh::Hierarchy& hierarchy, const RunParams& params, const Observer& observer);

}  // namespace thixis::drive
