#pragma once
#include <algorithm>

#include "thixis/complementarity/estimate.hpp"
#include "thixis/complementarity/parameters.hpp"

namespace thixis::complementarity {

/// eta_alg <= gamma_alg max(eta_disc, eta_lin), as a whole or (local) in every cell.
inline bool algebraic_error_is_small(const Estimate& eta, const StoppingParams& stopping) {
  if (stopping.local) return eta.worst_algebraic <= stopping.gamma_algebraic;
  return eta.algebraic <= stopping.gamma_algebraic * std::max(eta.discretization, eta.linearization);
}

/// eta_lin <= gamma_lin eta_disc, as a whole or (local) in every cell.
inline bool linearization_error_is_small(const Estimate& eta, const StoppingParams& stopping) {
  if (stopping.local) return eta.worst_linearization <= stopping.gamma_linearization;
  return eta.linearization <= stopping.gamma_linearization * eta.discretization;
}

}  // namespace thixis::complementarity
