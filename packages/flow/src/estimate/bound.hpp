#pragma once
#include <memory>

#include "estimate/measure.hpp"
#include "problem/jacobian.hpp"
#include "problem/scales.hpp"

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
  complementarity::Estimate operator()(const algebra::Vector& X, const Linearization& at);

  // Of the last estimate.
  models::StepErrors step_errors() const;
  const CellParts& cells() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::flow
