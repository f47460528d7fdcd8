#pragma once
#include <algorithm>
#include <vector>

#include "thixis/complementarity/estimate.hpp"
#include "thixis/complementarity/parameters.hpp"

namespace thixis::complementarity {

/// eta_alg <= gamma max(eta_disc, eta_lin), as a whole or (local) in every cell; gamma = gamma_alg, or less while Newton does not get
/// ahead.
inline bool algebraic_error_is_small(const Estimate& eta, const StoppingParams& stopping, double strictness = 1) {
  const double gamma = strictness * stopping.gamma_algebraic;
  if (stopping.local) return eta.worst_algebraic <= gamma;
  return eta.algebraic <= gamma * std::max(eta.discretization, eta.linearization);
}

/// eta_lin <= gamma_lin eta_disc, as a whole or (local) in every cell.
inline bool linearization_error_is_small(const Estimate& eta, const StoppingParams& stopping) {
  if (stopping.local) return eta.worst_linearization <= stopping.gamma_linearization;
  return eta.linearization <= stopping.gamma_linearization * eta.discretization;
}

/// As long as eta_lin is large eta_alg may be, too, and a few Krylov iterations satisfy the rule without moving the iterate: Newton is then
/// nothing but a Krylov method with very short cycles, and stands still. Where it does not get ahead, the next linear systems are solved
/// ten times better, and again; when eta_lin falls, as before.
class Strictness {
 public:
  double factor() const { return factor_; }

  /// After a step to an iterate with this estimate; `same_system`: the contact set of Newton-min did not change.
  void step(const Estimate& eta, bool same_system, const StoppingParams& stopping) {
    constexpr std::size_t window = 5;
    constexpr double fall = 0.8;              // in so many steps
    if (first_) return void(first_ = false);  // small there, eta_lin may rise in the second step
    eta_lin_.push_back(eta.linearization);
    const auto last = eta_lin_.end() - 1;
    const bool stands = eta_lin_.size() > window && *std::min_element(last - (window - 1), last + 1) > fall * *(last - window);
    if (!linearization_error_is_small(eta, stopping) && (same_system || stands)) {
      factor_ *= 0.1;
      eta_lin_.assign(1, eta.linearization);
    } else if (eta_lin_.size() > 1 && *last <= fall * *(last - 1)) {
      factor_ = 1;
    }
  }

 private:
  bool first_ = true;
  std::vector<double> eta_lin_;  ///< since it was looked at last
  double factor_ = 1;
};

}  // namespace thixis::complementarity
