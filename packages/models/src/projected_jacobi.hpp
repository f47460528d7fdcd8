#pragma once
#include "membrane_operator.hpp"

namespace thixis::models {

/// The projected Jacobi method, damped: at every node the membranes move to balance their forces; at contact points where they would pass
/// through each other they stay together at the place of least energy (one membrane: on the obstacle), and lambda is the force that this
/// takes. Solutions of the contact problem are its fixed points.
///
/// The damping is 4/3 over the largest eigenvalue of diag(S)^{-1} S, at most 2/3: half-way between no motion and divergence on the
/// stiffest mode, which differs between methods and degrees. For symmetric forms.
class ProjectedJacobi {
 public:
  /// Collective: estimates that eigenvalue by a dozen power iterations.
  explicit ProjectedJacobi(const MembraneOperator& membranes);
  /// Collective: one exchange of ghosts a sweep.
  void operator()(int sweeps, Fields& x) const;
  double damping() const { return damping_; }

 private:
  const MembraneOperator& membranes_;
  double damping_;
};

}  // namespace thixis::models
