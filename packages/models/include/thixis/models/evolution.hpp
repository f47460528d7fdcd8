#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thixis/mesh/build.hpp"
#include "thixis/models/model.hpp"

namespace thixis::models {

/// How a scene goes from u^{n-1} to u^n in a step of length tau. Backward Euler: d_t u(t_n) = rate(tau) (u^n - u^{n-1}), and all else is
/// taken at t_n; first order.
struct TimeScheme {
  const char* name = "backward Euler";
  double rate(double tau) const { return 1 / tau; }
};

/// A step ]begin, end], in the unit of time of the deck.
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

/// A scene in time on its mesh: X^0, and X^n from X^{n-1} step by step. All members are collective.
///
///     X = initial();
///     for each step:  begin(step, X_before);  solve problem() with any number of looks at estimate(X);  accept(X)
///
/// A step that fails is begun again, shorter, from the same X_before: nothing of it is kept. Before anything else is asked of X_before,
/// `give_up` returns to it. `save` and `restore` take the sums over the steps with them.
class Evolution : public SceneOnMesh {
 public:
  /// X^0 at time 0; its multipliers may be 0.
  virtual Teuchos::RCP<algebra::Vector> initial() = 0;
  /// Times at which data jump, in the unit of the deck: steps end there.
  virtual std::vector<double> jumps() const { return {}; }
  /// Throws InputError where data of one of these times leave no solution, as far as that shows without solving. Cheap.
  virtual void check(const std::vector<double>&) const {}

  /// Sets up problem() for a step. What does not depend on the length of the step or on the data at its end is kept.
  virtual void begin(const TimeStep& step, const algebra::Vector& before) = 0;
  /// To what rounding lets the residual of the step begun fall: a nonlinear solver is not asked for less.
  virtual double round_off() const { return 0; }
  /// A better start for Newton's method than X^{n-1}, from the steps before; false: there is none, X is left as it was.
  virtual bool predict(algebra::Vector&) { return false; }
  /// The parts of the last estimate; nothing where they are not known apart.
  virtual std::optional<StepErrors> step_errors() const { return {}; }
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
  virtual std::optional<double> error_so_far() const { return {}; }                        ///< if the exact solution is known
  virtual std::optional<complementarity::Estimate> estimate_so_far() const { return {}; }  ///< where every step was estimated
  /// Whether no step accepted so far, also before a checkpoint, went without its estimate.
  virtual bool every_step_estimated() const { return true; }
  /// What estimate_so_far() is, in words before a number.
  virtual std::string bound_name() const { return "energy error at most"; }
  virtual std::vector<Balance> balances() const { return {}; }

  /// Columns of series.csv behind the time, and their values.
  virtual std::vector<std::string> series_names() const { return {}; }
  virtual std::vector<double> series(const algebra::Vector&) const { return {}; }

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
