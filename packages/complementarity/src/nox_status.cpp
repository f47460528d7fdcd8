#include "nox_status.hpp"

#include <NOX_Solver_Generic.H>

#include <algorithm>
#include <cmath>

#include "adaptive_rule.hpp"

namespace thixis::complementarity {

NOX::StatusTest::StatusType Question::checkStatus(const NOX::Solver::Generic& solver, NOX::StatusTest::CheckType type) {
  if (type == NOX::StatusTest::None) return status_ = NOX::StatusTest::Unevaluated;
  const int k = solver.getNumIterations();
  const auto& group = dynamic_cast<const NoxGroup&>(solver.getSolutionGroup());
  const State& now = group.state();
  X_ = &group.X();
  const State& before = k == 0 ? now : dynamic_cast<const NoxGroup&>(solver.getPreviousSolutionGroup()).state();
  return status_ = ask(now, before, k) ? yes_ : NOX::StatusTest::Unconverged;
}

bool SmallResidual::ask(const State& now, const State& before, int k) {
  constexpr int patience = 5;
  if (!(now.residual <= system_.nonlinear_bound(now))) {
    in_a_row_ = 0;
    return false;
  }
  if (!patient_ || k == 0) return true;
  return ++in_a_row_ >= patience || now.residual <= 2 * system_.left() || now.active.changed(before.active) == 0;
}

bool SettledContactSet::ask(const State& now, const State& before, int k) {
  return k > 0 && system_.solved() && now.residual <= 2 * system_.left() && now.active.changed(before.active) == 0;
}

bool SmallEstimate::ask(const State& now, const State& before, int k) {
  if (k == 0) return false;
  const std::optional<Estimate>& eta = system_.estimate(X());
  const bool held_before = held_;
  held_ = linearization_error_is_small(*eta, system_.stopping()) && algebraic_excess(*eta, system_.stopping()) <= 1;
  return held_ && (eta->evident || held_before || now.active.changed(before.active) == 0);
}

bool Cycle::ask(const State& now, const State& before, int k) {
  if (k > 0 && !system_.solved()) visits_.clear();
  const auto [seen, first] = visits_.try_emplace(now.active.fingerprint(), Visit{k, now.residual});
  if (first) return false;
  const bool left = now.active.fingerprint() != before.active.fingerprint();
  const bool same = std::abs(now.residual - seen->second.residual) <= 1e-3 * seen->second.residual;
  period_ = k - seen->second.k;
  seen->second = {k, now.residual};
  return left && same;
}

bool Fallen::ask(const State& now, const State&, int k) {
  if (k == 0) start_ = now.residual;
  return k > 0 && now.residual <= factor_ * start_;
}

bool Growing::ask(const State& now, const State&, int k) {
  constexpr int window = 10;
  residuals_.push_back(now.residual);
  if (k < window) return false;
  grown_ = now.residual > residuals_[k - window] ? grown_ + 1 : 0;
  return grown_ >= window;
}

bool Diverged::ask(const State& now, const State&, int k) {
  constexpr double too_far = 1e20;
  if (k == 0) start_ = std::max(now.residual, system_.reference());
  factor_ = now.residual / start_;
  return factor_ > too_far;
}

}  // namespace thixis::complementarity
