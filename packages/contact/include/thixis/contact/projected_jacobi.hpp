#pragma once
#include "thixis/contact/system.hpp"

namespace thixis::contact {

/// The projected Jacobi method, damped: at every node the fields move to balance their forces; where gaps would become negative they are
/// closed at the place of least energy of the node's own stiffness, and lambda is the force that this takes. Solutions of the contact
/// problem are its fixed points.
///
/// The damping is 4/3 over the largest eigenvalue of diag(S)^{-1} S, at most 2/3: half-way between no motion and divergence on the
/// stiffest mode, which differs between methods and degrees. For symmetric S.
class ProjectedJacobi {
 public:
  /// Collective: estimates that eigenvalue by a dozen power iterations.
  explicit ProjectedJacobi(const System& system);
  /// On X. Collective.
  void operator()(int sweeps, algebra::Vector& X) const;
  double damping() const { return damping_; }

 private:
  const System& system_;
  double damping_;
  Kokkos::View<const LocalIndex*> point_;  ///< of each node, or -1
};

}  // namespace thixis::contact
