#pragma once
#include "step/operator.hpp"

namespace thixis::flow {

/// Closes the balances of water and hydrogen over the whole domain, which the rows of a linear system imply and its iterates miss
/// (docs/methods/two_phase.md, 4).
class Balancing {
 public:
  /// Collective.
  explicit Balancing(const TwoPhaseOperator& flow);

  /// Y <- Y + Z c with W^T (B - A Y) = 0. What the solver left, residual, becomes |B - A Y|; both stay as they are where the 2x2 system is
  /// nearly singular, and where the residual would grow so much that a step of Newton's method could suffer. `states`: where A was
  /// linearized. Collective.
  void operator()(const fv::View<PhaseState*>& states, const algebra::Matrix& A, const algebra::Vector& B, algebra::Vector& Y,
                  double& residual) const;

 private:
  Teuchos::RCP<algebra::Vector> mode(int component, const fv::View<PhaseState*>& states) const;

  const TwoPhaseOperator& flow_;
  double volume_;  ///< of all cells, on all ranks
  bool open_;      ///< part of the boundary is of kind state
};

}  // namespace thixis::flow
