#pragma once
#include <functional>
#include <optional>

#include "thixis/algebra/fwd.hpp"

namespace thixis::complementarity {

/// What an estimate promises, the strongest first (docs/methods/estimates.md, 8).
enum class Promise {
  guaranteed,        ///< never below the error: the proof covers all that was computed
  up_to_quadrature,  ///< never below the error of the problem whose data are what the quadrature sees of them
  indicator          ///< no bound on an error is claimed
};

/// What two promises are worth together.
constexpr Promise weakest(Promise a, Promise b) { return a < b ? b : a; }

/// "guaranteed", "up to quadrature of the data", "indicator": as it is printed everywhere.
constexpr const char* to_text(Promise promise) {
  return promise == Promise::guaranteed         ? "guaranteed"
         : promise == Promise::up_to_quadrature ? "up to quadrature of the data"
                                                : "indicator";
}

/// An estimate of the error of an iterate X^{k,i} in the energy norm and its parts (docs/methods/estimates.md),
///
///     |||u - u_h^{k,i}||| <= total <= discretization + linearization + algebraic,
///
/// the first of these inequalities as far as `promise` says.
struct Estimate {
  double total = 0;
  double discretization = 0;  ///< eta_disc: what a finer mesh would take away
  double linearization = 0;   ///< eta_lin: what further Newton steps would take away; 0 at their end
  double algebraic = 0;       ///< eta_alg: what further Krylov iterations would take away
  /// The worst cell: max over K of eta_alg,K / max(eta_disc,K, eta_lin,K) and of eta_lin,K / eta_disc,K, for the cell-wise rule; 0 where
  /// it is not asked for.
  double worst_algebraic = 0, worst_linearization = 0;
  /// linearization holds all that the nonlinear equations and the contact conditions miss at this iterate: small once is small. Otherwise
  /// it may be small at one iterate and larger at the next, and the rule `adaptive` looks twice.
  bool evident = false;
  /// Where the problem is one in time: how much of eta_disc shorter steps would take away (StepErrors::time); no summand.
  std::optional<double> time = std::nullopt;
  Promise promise = Promise::indicator;
};

/// Looks at an iterate. Collective; the same on all ranks.
using Estimator = std::function<Estimate(const algebra::Vector& X)>;

}  // namespace thixis::complementarity
