#pragma once
#include <cstdint>
#include <string>

#include "adaptive_rule.hpp"
#include "thixis/complementarity/newton.hpp"
#include "views.hpp"

namespace thixis::complementarity {

/// What is known about an iterate.
struct State {
  ActiveSet active;
  double residual = 0;         ///< |(E(X) - F, C(X))|, in the norm of the problem as the others
  double equations = 0;        ///< |E(X) - F|
  double complementarity = 0;  ///< |C(X)|
  double round_off = 0;        ///< what rounding may have left in `residual`
};

/// No next iterate: the linear solver or the line search failed. `why` is the rest of a sentence about the step.
struct StepFailed {
  std::string why;
};

/// R(X) = (E(X) - F, C(K(X), s G(X))) with its generalized derivative and the rules of `stopping` for linear systems: what the NOX group
/// asks for. The C-function may be changed between steps.
class System {
 public:
  System(Problem& problem, const NewtonParams& newton, const StoppingParams& stopping, int check_every, const NewtonObserver& observer,
         const Estimator& estimator);

  void use(CFunction function) { function_ = function; }
  CFunction function() const { return function_; }
  /// The Newton step that linear systems belong to, for the observer.
  void begin_step(int step) { step_ = step; }

  /// Overwrites R.
  void residual(const algebra::Vector& X, algebra::Vector& R, State& state);
  /// A(X) for the contact set that `residual` found at X; kept inside the problem.
  void linearize(const algebra::Vector& X, const ActiveSet& active);
  /// A(X) dX = -R with the A of the last `linearize`, then (Newton-min) the smoothing that the deck asks for: it finds the contact set, and
  /// where that did not change in a step that was solved it would only bring back residuals that the step takes off. Throws StepFailed on
  /// all ranks.
  void solve(const algebra::Vector& X, const State& state, const algebra::Vector& R, algebra::Vector& dX);

  /// The estimate at an iterate that is to be judged, if there is anybody who wants it; kept until the iterate moves.
  const std::optional<Estimate>& estimate(const algebra::Vector& X);
  /// A step has led to the iterate of the present estimate and changed so many contact points: is Newton getting ahead?
  void end_step(long long changed);
  /// The iterate is no longer the one that the linear solver left.
  void forget_estimate() { estimate_.reset(); }
  const StoppingParams& stopping() const { return stopping_; }

  /// What the residual of an iterate may be.
  double nonlinear_bound(const State& state) const { return stopping_.nonlinear_residual(reference_, state.round_off); }
  double reference() const { return reference_; }               ///< |(F, 0)|, or the first residual where that is 0
  int linear_iterations() const { return linear_iterations_; }  ///< of all systems
  bool solved() const { return solved_; }                       ///< the last system, to its tolerance
  bool failed() const { return failures_ > 0; }                 ///< … and it was not solved at all
  double left() const { return left_; }                         ///< bound on the residual of the last system
  void say(const std::string& sentence) const {
    if (observer_.message) observer_.message(sentence);
  }

 private:
  double norm(const algebra::Vector& R);
  double linear_tolerance(double rhs, const State& state) const;
  bool asks_estimator() const;
  bool asks_criterion() const;
  bool look(const algebra::Vector& X, const algebra::Vector& R, const algebra::Vector& dX, int iteration, double residual, double rhs);
  bool enough(double residual, double rhs, LinearRecord& record);
  bool left_to_rounding(const algebra::Vector& X, const algebra::Vector& dX, double residual) const;
  void judge(const algebra::LinearReport& report, double tolerance, double residual, double correction);

  Problem& problem_;
  const NewtonParams& newton_;
  const StoppingParams& stopping_;
  const NewtonObserver& observer_;
  const Estimator& estimator_;
  int check_every_;
  CFunction function_;
  algebra::Vector K_, G_, s_, C_, a_, b_;
  Teuchos::RCP<algebra::Vector> weights_, weighted_;  ///< of the rows; null: all are 1
  double reference_;
  int step_ = 0;
  int linear_iterations_ = 0;
  int failures_ = 0;  ///< linear systems in a row that were not solved
  bool solved_ = false;
  std::uint64_t contact_set_ = 0;  ///< fingerprint of the one that the last step started from
  double left_ = 0;
  struct Looked;
  std::shared_ptr<Looked> looked_;    ///< at the iterate of the linear solver; made at the first look
  double worth_looking_ = 0;          ///< residual of the linear system below which the next estimate is asked for
  int waiting_ = 0;                   ///< looks without an estimate since the last one
  int looked_at_ = 0;                 ///< last iteration of the linear solver that `look` has seen
  std::optional<Estimate> estimate_;  ///< at the present iterate
  Strictness strictness_;             ///< of the rule `adaptive`
};

}  // namespace thixis::complementarity
