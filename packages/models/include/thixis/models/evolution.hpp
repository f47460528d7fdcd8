#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thixis/complementarity/active_set.hpp"
#include "thixis/complementarity/estimate.hpp"
#include "thixis/complementarity/kkt.hpp"
#include "thixis/complementarity/problem.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/models/model.hpp"
#include "thixis/models/params.hpp"
#include "thixis/output/checkpoint.hpp"
#include "thixis/output/fields.hpp"
#include "thixis/output/summary.hpp"

namespace thixis::models {

/// A step ]begin, end] of backward Euler, in the unit of time of the deck.
struct TimeStep {
  double begin = 0, end = 0;
  double length() const { return end - begin; }
};

/// What is conserved: by how much the steps so far have missed it, relative (docs/methods/two_phase.md).
struct Balance {
  std::string name;       ///< of the component
  double of_step = 0;     ///< defect of the last step
  double worst_step = 0;  ///< the largest of all steps
  double total = 0;       ///< of the sum over all steps
};

/// The two parts of the discretization error of a step that step control compares.
struct StepErrors {
  double time = 0;        ///< from replacing the solution in ]t_{n-1}, t_n] by its value at t_n
  double space = 0;       ///< the rest
  double negligible = 0;  ///< an error in the step below it counts for nothing, however small the other part is
};

/// Why X, which solves a step for the nonlinear solver, may not end it.
struct Objection {
  std::string why;         ///< a sentence that says what to try; empty: it may
  bool too_loose = false;  ///< X is near a solution: the solver may come nearer with smaller tolerances
  explicit operator bool() const { return !why.empty(); }
};

/// A number that a run ends with, and the bounds that the deck expects it within. In words: "front 3 is not between 0 and 1".
struct Expectation {
  std::string what;
  std::optional<double> value;  ///< none: it is not known
  std::optional<double> least, most;
};

/// What a scene must bring to the next step beside X.
struct EvolutionState {
  std::vector<output::CheckpointBlock> blocks;
  std::map<std::string, double> attributes;  ///< sums over the steps so far
};

/// A scene in time on its mesh: X^0, and X^n from X^{n-1} step by step. All members are collective.
///
///     X = initial();
///     for each step:  begin(step, X_before);  solve problem() with any number of looks at estimate(X);  accept(X)
///
/// A step that fails is begun again, shorter, from the same X_before: nothing of it is kept. Before anything else is asked of X_before,
/// `give_up` returns to it.
class Evolution {
 public:
  virtual ~Evolution();

  virtual const core::Comm& comm() const = 0;
  virtual GlobalIndex cells() const = 0;
  virtual Sizes sizes() const = 0;  ///< of each step

  /// X^0 at time 0; its multipliers may be 0.
  virtual Teuchos::RCP<algebra::Vector> initial() = 0;
  /// Times at which data jump, in the unit of the deck: steps end there.
  virtual std::vector<double> jumps() const { return {}; }
  /// Throws InputError where data of one of these times leave no solution, as far as that shows without solving. Cheap.
  virtual void check(const std::vector<double>&) const {}
  /// Sets up problem() for a step. What does not depend on the length of the step or on the data at its end is kept.
  virtual void begin(const TimeStep& step, const algebra::Vector& before) = 0;
  /// Of the step begun.
  virtual complementarity::Problem& problem() = 0;
  /// To what rounding lets the residual of the step begun fall: a nonlinear solver is not asked for less.
  virtual double round_off() const { return 0; }
  /// A better start for Newton's method than X^{n-1}, from the steps before; false: there is none, X is left as it was.
  virtual bool predict(algebra::Vector&) { return false; }

  /// The share of the step begun in the bound on the error over all time, at any X of the step: sqrt of an integral over the step. What it
  /// needs of the mesh is set up at the first call; a run that never asks pays nothing. Throws InputError where the scene has no bound.
  virtual complementarity::Estimate estimate(const algebra::Vector& X) = 0;
  virtual CellEstimates cell_estimates() const = 0;                     ///< of the last call of `estimate`
  virtual std::optional<StepErrors> step_errors() const { return {}; }  ///< likewise; nothing where they are not known apart

  /// Whether X, which solves the step for the nonlinear solver, may end it. `tolerance`: of the verifier; `conditions`: whether balances
  /// and contact conditions count, which the rule adaptive leaves open.
  virtual Objection objection(const algebra::Vector&, double /*tolerance*/, bool /*conditions*/) { return {}; }
  /// What the log should say of the step that was estimated, in a sentence; empty: nothing.
  virtual std::string remark() const { return {}; }

  /// The step begun is given up, also where `begin` has thrown: the data are those of X_before again.
  virtual void give_up() {}

  /// The step ends with X. If `estimate` was called since begin(), its last call was at X, and the bound so far takes it in.
  virtual void accept(const algebra::Vector& X) = 0;

  // Over ]0, t_n], the steps accepted.
  virtual std::optional<double> energy_error() const { return {}; }  ///< if the exact solution is known
  /// Of the step begun alone, if it ended with X: what `estimate` bounds.
  virtual std::optional<double> step_energy_error(const algebra::Vector&) const { return {}; }
  virtual std::optional<complementarity::Estimate> estimate_so_far() const { return {}; }  ///< where every step was estimated
  /// Whether no step accepted so far, also before a checkpoint, went without its estimate.
  virtual bool every_step_estimated() const { return true; }
  /// What keeps it from being guaranteed, a clause each.
  virtual std::vector<std::string> doubts() const { return {}; }
  /// What estimate_so_far() is, in words before a number.
  virtual std::string bound_name() const { return "energy error at most"; }
  virtual std::vector<Balance> balances() const { return {}; }

  // Of X at the end of a step, or of X^0.
  virtual double energy_norm(const algebra::Vector&) const { return 0; }
  virtual complementarity::KktData kkt_data(const algebra::Vector& X) const = 0;
  virtual std::optional<Contact> contact(const algebra::Vector&) const { return {}; }
  /// The fields of Model::point_fields at points, [probe][field], on all ranks. Collective.
  virtual std::vector<double> values_at(const std::vector<Probe>&, const algebra::Vector&) const { return {}; }
  /// What the deck expects of this model alone (ExpectParams::own), with what was found.
  virtual std::vector<Expectation> expectations(const ExpectParams&, const algebra::Vector&) const { return {}; }
  /// What the summary says of this model alone.
  virtual std::vector<output::SummaryEntry> summary(const algebra::Vector&) const { return {}; }
  /// Columns of series.csv behind the time, and their values.
  virtual std::vector<std::string> series_names() const { return {}; }
  virtual std::vector<double> series(const algebra::Vector&) const { return {}; }
  virtual output::Grid grid() const = 0;
  /// The fields that the model can show, by name; `names` empty: all.
  virtual std::vector<output::FieldData> fields(const algebra::Vector& X, const complementarity::ActiveSet& active,
                                                const std::vector<std::string>& names) const = 0;

  /// Everything that steps after X depend on, by ids that do not depend on the number of ranks.
  virtual EvolutionState save(const algebra::Vector& X) const = 0;
  /// The X that was saved, exactly, and the sums that go with it. Throws InputError if it belongs to another scene, mesh or method.
  virtual Teuchos::RCP<algebra::Vector> restore(const output::StoredCheckpoint& stored) = 0;

  /// Refines the cells with these ids; X is then what it was on the finer mesh. For scenes whose `hierarchy` is not null.
  virtual const mesh::Hierarchy* hierarchy() const { return nullptr; }
  virtual Teuchos::RCP<algebra::Vector> refine(const std::vector<GlobalIndex>&, const algebra::Vector&) { return Teuchos::null; }
};

/// A scene in time before it meets a mesh.
class UnsteadyModel : public Model {
 public:
  /// Evolution::check as far as it needs no mesh, for `thixis check`.
  virtual void check(const mesh::MeshParams&, const std::vector<double>&) const {}
  /// On the mesh of the deck (`folder`: that of the deck). Throws InputError for what only a mesh shows, as StationaryModel::check does,
  /// before anything is computed or written. Collective.
  virtual std::unique_ptr<Evolution> evolve(const mesh::MeshParams& mesh, const core::Comm& comm, const std::string& folder,
                                            const Wanted& wanted) const = 0;
};

}  // namespace thixis::models
