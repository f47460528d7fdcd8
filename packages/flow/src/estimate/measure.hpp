#pragma once
#include "estimate/cell_errors.hpp"
#include "thixis/complementarity/estimate.hpp"
#include "thixis/flow/two_phase.hpp"

namespace thixis::flow {

/// The estimate of each owned cell. phase_transition: mean over the cell and the step of s_g^+ G^+/(H P_ref), which is large where gas
/// comes or goes.
struct CellParts {
  fv::View<double*> discretization, linearization, algebraic, phase_transition;
};

/// What the norms of cells come to in a step: in the measure of the residuals (5.2) or in that of the literature (6.1), equations of
/// docs/methods/two_phase_estimates.md.
class StepMeasure {
 public:
  /// Collective.
  StepMeasure(const fv::Grid& grid, const TwoPhaseBoundParams& params);

  bool literature() const { return params_.measure == complementarity::Measure::literature; }
  /// From CellErrors::out of a step of this length. Collective.
  complementarity::Estimate operator()(const fv::View<double* [parts_of_cell]>& errors, double length);

  // Of the last call.
  const models::StepErrors& step_errors() const { return of_step_; }
  const CellParts& cells() const { return cells_; }

 private:
  complementarity::Estimate of_residuals(const fv::View<double* [parts_of_cell]>& errors, double length);
  complementarity::Estimate of_literature(const fv::View<double* [parts_of_cell]>& errors, double length);
  void set_cells(const fv::View<double* [parts_of_cell]>& errors, double iteration_unit, double discretization_unit,
                 double transition_unit);

  const fv::Grid& grid_;
  TwoPhaseBoundParams params_;
  double volume_, squared_diagonal_;
  CellParts cells_;
  models::StepErrors of_step_;
};

}  // namespace thixis::flow
