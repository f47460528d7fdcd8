#include "system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "thixis/core/timer.hpp"

namespace thixis::complementarity {

System::System(Problem& problem, const NewtonParams& newton, const StoppingParams& stopping, int check_every,
               const NewtonObserver& observer, const Estimator& estimator)
    : problem_(problem),
      newton_(newton),
      stopping_(stopping),
      observer_(observer),
      estimator_(estimator),
      check_every_(check_every),
      function_(newton.c_function),
      K_(problem.points()),
      G_(problem.points()),
      s_(problem.points()),
      C_(problem.points()),
      a_(problem.points()),
      b_(problem.points()),
      weights_(Teuchos::rcp(new algebra::Vector(problem.map()))),
      reference_(problem.reference_norm()) {
  if (problem.weights(*weights_)) weighted_ = Teuchos::rcp(new algebra::Vector(problem.map()));
  else weights_ = Teuchos::null;
  s_.putScalar(1);
  if (newton.scaling != Scaling::physical) return;
  problem.scaling(s_);
  bool positive = true;
  for (const double s : s_.getData()) positive = positive && s > 0 && std::isfinite(s);
  if (!comm_of(*s_.getMap()).all(positive))
    throw core::Error(core::ExitCode::internal, "The scaling of the multiplier must be positive at every contact point.");
}

double System::norm(const algebra::Vector& R) {
  if (weights_.is_null()) return R.norm2();
  weighted_->elementWiseMultiply(1, *weights_, R, 0);
  return weighted_->norm2();
}

void System::residual(const algebra::Vector& X, algebra::Vector& R, State& state) {
  problem_.arguments(X, K_, G_);
  const double tie = newton_.tie_tolerance > 0 ? newton_.tie_tolerance * problem_.gap_size(X, K_, G_, s_) : 0.0;
  state.active.set(K_, G_, s_, newton_.ties, tie);
  evaluate(function_, K_, G_, s_, state.active, C_);
  R.putScalar(0);
  problem_.insert(C_, R);
  state.complementarity = norm(R);
  problem_.equations(X, R);
  state.equations = norm(R);
  problem_.insert(C_, R);
  state.residual = std::hypot(state.equations, state.complementarity);
  state.round_off = problem_.noise(X);
  if (!(reference_ > 0)) reference_ = state.residual;
}

void System::linearize(const algebra::Vector& X, const ActiveSet& active) {
  problem_.arguments(X, K_, G_);
  differentiate(function_, K_, G_, s_, active, a_, b_);
  problem_.linearize(X, a_, b_);
}

constexpr double digits = 1e-14;  ///< what a linear solver can reduce a residual to, at best

/// Never more than a tenth of the residual that the step starts from: a solver that has nothing to do would not move X.
double System::linear_tolerance(double rhs, const State& state) const {
  const double possible = std::max(0.1 * state.round_off, digits * state.residual);
  const double wanted = std::max({stopping_.linear_tolerance * rhs, 0.1 * stopping_.absolute_tolerance, possible});
  return std::min(wanted, 0.1 * state.residual);
}

/// An estimate costs as much as some iterations: after one that exceeds what is allowed by a factor e, the next one waits until the
/// residual has fallen by e/impatience, but for no more than so many looks: what is allowed changes, too.
constexpr double impatience = 3;
constexpr int most_waiting = 3;

/// X_i with what is computed there.
struct System::Looked {
  algebra::Vector X, R;
  State state;
  explicit Looked(const algebra::MapPtr& map) : X(map), R(map) {}
};

namespace {

/// The problem knows that an iterate is looked at, as long as this is there.
struct Look {
  const Problem& problem;
  Look(const Problem& of, const algebra::Vector& Xi, const algebra::Vector& R) : problem(of) { problem.look_at(Xi, R); }
  ~Look() { problem.look_away(); }
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;
};

}  // namespace

bool System::look(const algebra::Vector& X, const algebra::Vector& R, const algebra::Vector& dX, int iteration, double residual,
                  double rhs) {
  LinearRecord record{step_, iteration, residual, std::nullopt};
  bool ends = false;
  forget_estimate();
  const bool waits = residual > worth_looking_ && waiting_++ < most_waiting;
  if (iteration > 0 && asks_criterion() && !waits) {
    waiting_ = 0;
    if (!looked_) looked_ = std::make_shared<Looked>(X.getMap());
    looked_->X.update(1, X, 1, dX, 0);
    const Look look(problem_, looked_->X, R);
    ends = enough(residual, rhs, record);
  }
  if (observer_.linear) observer_.linear(record);
  looked_at_ = iteration;
  return ends;
}

/// At the iterate that is looked at.
bool System::enough(double residual, double rhs, LinearRecord& record) {
  record.estimate = estimate(looked_->X);
  if (stopping_.rule == StoppingRule::adaptive) {
    const double excess = algebraic_excess(*record.estimate, stopping_, strictness_.factor());
    if (!stopping_.estimate.value_or(false) && std::isfinite(excess)) worth_looking_ = residual * std::min(1.0, impatience / excess);
    return excess <= 1;
  }
  if (stopping_.rule != StoppingRule::inexact) return false;
  this->residual(looked_->X, looked_->R, looked_->state);
  return residual / rhs <= stopping_.inexact_factor * looked_->state.residual / reference_;
}

bool System::asks_estimator() const {
  return estimator_ && (stopping_.rule == StoppingRule::adaptive || stopping_.estimate.value_or(false));
}

/// Whether the iterates of the linear solver are of interest.
bool System::asks_criterion() const { return stopping_.rule != StoppingRule::exact || asks_estimator(); }

const std::optional<Estimate>& System::estimate(const algebra::Vector& X) {
  if (asks_estimator() && !estimate_) {
    const core::Region region("estimate");
    estimate_ = estimator_(X);
  }
  return estimate_;
}

void System::end_step(long long changed) {
  if (stopping_.rule != StoppingRule::adaptive || !estimate_) return;
  strictness_.step(*estimate_, function_ == CFunction::min && changed == 0, stopping_);
}

void System::solve(const algebra::Vector& X, const State& state, const algebra::Vector& R, algebra::Vector& dX) {
  const double residual = state.residual;
  const bool settled = solved_ && state.active.fingerprint() == contact_set_;
  contact_set_ = state.active.fingerprint();
  double rhs = problem_.rhs_norm(X, R);
  if (!(rhs > 0)) rhs = residual;
  algebra::LinearStop stop;
  stop.tolerance = linear_tolerance(rhs, state);
  forget_estimate();
  looked_at_ = 0;
  worth_looking_ = std::numeric_limits<double>::infinity();
  waiting_ = 0;
  if (check_every_ > 0 && (asks_criterion() || observer_.linear)) {
    stop.check_every = check_every_;
    stop.criterion = [&](const algebra::Vector& dXi, int iteration, double left) { return look(X, R, dXi, iteration, left, rhs); };
  }
  algebra::LinearReport report = problem_.solve(R, dX, stop);
  report.converged = report.converged || left_to_rounding(X, dX, report.residual);
  linear_iterations_ += report.iterations;
  solved_ = report.converged && !report.by_criterion && !report.shortened;
  left_ = std::max(stop.tolerance, report.residual);
  if (looked_at_ != report.iterations || report.shortened) forget_estimate();
  judge(report, stop.tolerance, residual, dX.norm2());
  if (const int sweeps = newton_.sweeps.value_or(0); sweeps > 0 && function_ == CFunction::min && !settled) {
    algebra::Vector relaxed(X, Teuchos::Copy);
    relaxed.update(1, dX, 1);
    problem_.relax(relaxed, sweeps);
    dX.update(1, relaxed, -1, X, 0);
    forget_estimate();
  }
}

/// Steps that move X far leave more than rounding at X let expect.
bool System::left_to_rounding(const algebra::Vector& X, const algebra::Vector& dX, double residual) const {
  algebra::Vector next(X, Teuchos::Copy);
  next.update(1, dX, 1);
  return residual <= problem_.noise(next);
}

void System::judge(const algebra::LinearReport& report, double tolerance, double residual, double correction) {
  const bool finite = std::isfinite(correction) && std::isfinite(report.residual);
  failures_ = finite && report.converged ? 0 : failures_ + 1;
  if (!finite)
    throw StepFailed{report.reason.empty() ? "the linear solver returned numbers that are not finite"
                                           : "the linear solver found nothing: " + report.reason};
  if (report.converged) return;
  const std::string what = fmt::format("the linear solver left a residual of {:.2e}, not {:.2e}{}{}", report.residual, tolerance,
                                       report.reason.empty() ? "" : ": ", report.reason);
  if (failures_ > 1) throw StepFailed{what + ", for the second time"};
  if (report.residual > 0.5 * residual) throw StepFailed{what};
  say(fmt::format("Newton step {}: {}; the step is taken and the next system is the second try.", step_, what));
}

}  // namespace thixis::complementarity
