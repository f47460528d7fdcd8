#pragma once
#include <memory>

#include "problem/problem.hpp"
#include "thixis/complementarity/estimate.hpp"
#include "thixis/flow/two_phase.hpp"

namespace thixis::flow {

/// The estimate of a step of backward Euler at any iterate (docs/methods/two_phase_estimates.md), split into the parts that a finer grid
/// and shorter steps, further Newton steps, and further Krylov iterations would take away.
class TwoPhaseBound {
 public:
  /// What the grid needs is set up here. `flow` must outlive it. Collective.
  TwoPhaseBound(const TwoPhaseOperator& flow, const FlowScales& scales, const TwoPhaseBoundParams& params);
  ~TwoPhaseBound();
  TwoPhaseBound(const TwoPhaseBound&) = delete;
  TwoPhaseBound& operator=(const TwoPhaseBound&) = delete;

  /// Estimates are those of this step, from X^{n-1}, from now on. Collective.
  void begin(const FlowStep& step, const algebra::Vector& before);
  /// The share of the step at X^{k,i}; `at`: where the system that X solves nearly was linearized, X null: nowhere, X solves none.
  /// Collective.
  complementarity::Estimate operator()(const algebra::Vector& X, const TwoPhaseProblem::Linearization& at);

  // Of the last estimate.
  models::StepErrors step_errors() const;
  /// Of the owned cells. phase_transition: mean over the cell and the step of s_g^+ G^+/(H P_ref), which is large where gas comes or goes.
  struct Cells {
    fv::View<double*> discretization, linearization, algebraic, phase_transition;
  };
  const Cells& cells() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::flow
