#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "thixis/complementarity/newton.hpp"
#include "thixis/drive/effort.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/models/model.hpp"

namespace thixis::drive {

/// One row of the history; what was not computed is empty.
struct Progress {
  int level = 0;
  std::optional<int> newton, linear;
  std::optional<long long> active, changed;
  std::optional<double> residual, energy_error;
  std::optional<complementarity::Estimate> estimate;
};

/// How far a solve has come, with what it took on all levels.
struct Position : Effort {
  int level = 0;
  int newton_on_level = 0;  ///< Newton steps on this level
};

/// Who follows a solve; functions may be empty.
struct Observer {
  std::function<void(const mesh::Mesh& mesh, int level, const models::Sizes& sizes)> level;
  std::function<void(const Progress&, const complementarity::NewtonRecord&)> step;
  std::function<void(const Position&, const models::Discretization&, const algebra::Vector& X)> iterate;  ///< after `step`
  std::function<void(const Progress&)> check;
  /// The end of a level, solved or not, with its estimate and energy error; only where the error is estimated.
  std::function<void(const Progress&)> level_end;
  /// The mesh of `level` has come from refining the cells with these ids (rising, the same on all ranks) of the level before.
  std::function<void(int level, const std::vector<GlobalIndex>& marked)> refined;
  std::function<void(const std::string&)> message;
};

/// The solution on the finest level reached, and what it took.
struct Outcome {
  const mesh::Mesh* mesh = nullptr;
  std::unique_ptr<models::Discretization> discretization;
  Teuchos::RCP<algebra::Vector> X;
  bool solved = false;
  bool not_wanted = false;               ///< max iterations = 0: only counted
  complementarity::NewtonReport finest;  ///< its steps are those of this run alone
  Position at;
  std::optional<complementarity::Kkt> kkt;
  double kkt_tolerance = 0;  ///< what the verifier lets pass
  std::optional<double> energy_error;
  double energy_norm = 0;
  models::Rounding rounding;
  std::optional<models::Contact> contact;
  std::map<std::string, double> at_points;            ///< what `expect/at` asks for, by its names
  std::vector<models::Expectation> of_model;          ///< what `expect` asks of the model alone
  std::vector<output::SummaryEntry> summary;          ///< what the model has to say of X
  bool nested = false;                                ///< the level began (also before a restart) from the solution on the one before
  std::optional<complementarity::Estimate> estimate;  ///< at X, where the error is estimated; not if X is not finite
  models::CellEstimates cell_estimates;
  std::optional<models::PublishedEstimate> published;  ///< stopping/estimate = true only
  std::string refinement_ended;  ///< adaptive runs that ended without the target: by which limit, e.g. "adapt/max levels = 3"
  std::string to_try;            ///< then: a clause that says what to set

  std::optional<double> effectivity() const;  ///< estimate / energy error, if both are known
};

/// Solves a stationary scene: on the finest mesh from a cold start, or (newton/start = nested) on all meshes, coarsest first, each from the
/// solution on the mesh before. Keeps the last iterate where Newton does not converge.
///
/// Adaptive runs (RunParams::adaptive) go on from there: they mark cells by their discretization error, append a level to the hierarchy and
/// solve on it, from the solution before, until the bound meets stopping/target or a limit of `adapt` comes first. No mesh with more than
/// adapt/max unknowns is solved: the run ends before it; InputError if it would begin with one.
///
/// With a checkpoint (`stored`, not null) it goes on from the level and the iterate of that one, and on finer levels as `nested` does.
/// Newton itself begins anew there: `newton/max iterations` limits the steps since the restart, and what its safeguards had seen (cycles,
/// damped steps under way) is forgotten. Step numbers and counts go on.
Outcome solve_stationary(const models::StationaryModel& model, mesh::Hierarchy& hierarchy, const RunParams& params,
                         const Observer& observer, const output::StoredCheckpoint* stored = nullptr);

}  // namespace thixis::drive
