#pragma once
#include <optional>

#include "problem/balancing.hpp"
#include "problem/jacobian.hpp"
#include "thixis/algebra/solver.hpp"
#include "thixis/complementarity/problem.hpp"

namespace thixis::flow {

/// A step of two-phase flow as the nonlinear solver sees it (docs/methods/two_phase.md, 4): X = (s_g, P, chi) interlaced by cell,
///
///     R_c = w_c [ |K| (l_c - l_c^{n-1} + owed_c)/tau + sum_F ± |F| Phi_c - |K| Q_c ] tau/(|K| mass_c),   c = w, h,
///     K = s_g,   G = H P_g - beta_l chi  [kg/m^3],
///
/// owed_c what the step before has left of its own equations. The weights w_c >= 1 make a tolerance relative to what is in place one
/// relative to what the step moves (4), down to rounding.
///
/// Rows of a cell: contact, water, hydrogen. So the diagonal holds the derivatives by s_g, P, chi that dominate them, and incomplete
/// factors of level 0 are exact in one dimension. `solve` asks for more where what is left of a row would move its unknown, closes the
/// linearized balances of both components to rounding, and shortens increments to where the laws resemble their tangents.
class TwoPhaseProblem final : public complementarity::Problem {
 public:
  /// `origin`: the state from which |B| counts X (rhs_norm).
  TwoPhaseProblem(const TwoPhaseOperator& flow, const FlowScales& scales, const algebra::LinearParams& params,
                  Teuchos::RCP<const algebra::Vector> origin);

  /// The step to be solved from now on.
  void begin(FlowStep step);
  const FlowStep& step() const { return step_; }
  const FlowScales& scales() const { return scales_; }
  double weight(int component) const { return weight_[component]; }
  /// A unit in the last place of the pressures, in the equations of water: rounding lets |R| fall no further.
  double round_off() const { return round_off_; }
  /// What X leaves of the balances of the owned cells, owed included [kg/m^3].
  fv::View<double* [components]> left(const algebra::Vector& X) const;
  /// Where the equations of the step were linearized last.
  const Linearization& linearization() const { return at_; }

  algebra::MapPtr map() const override { return flow_.map(); }
  algebra::MapPtr points() const override { return flow_.cells(); }
  void equations(const algebra::Vector& X, algebra::Vector& R) const override;
  void arguments(const algebra::Vector& X, algebra::Vector& K, algebra::Vector& G) const override;
  /// s = 1/(H P_ref).
  void scaling(algebra::Vector& s) const override;
  void insert(const algebra::Vector& C, algebra::Vector& R) const override;
  void linearize(const algebra::Vector& X, const algebra::Vector& a, const algebra::Vector& b) override;
  algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) override;
  /// F: the masses at the beginning of the step and what sources and faces of kind flux bring, over mass_c.
  double reference_norm() const override { return reference_norm_; }
  /// |A (X - origin) - R|: X itself would bring in the level of the pressure, which means nothing.
  double rhs_norm(const algebra::Vector& X, const algebra::Vector& R) const override;

  GlobalIndex nonzeros() const;
  /// A of the last `linearize`, for increments divided by scales().unknown.
  const algebra::Matrix& matrix() const { return *pattern_->matrix; }

 private:
  double brought_norm(double length) const;
  void set_weights(double in_place);
  FlowScales row_scales() const;
  void scale(algebra::Vector& X, bool up) const;
  void sharpen(const algebra::Vector& B, algebra::Vector& Y, algebra::LinearReport& report) const;

  const TwoPhaseOperator& flow_;
  FlowScales scales_;
  Teuchos::RCP<const algebra::Vector> origin_;
  FlowStep step_;
  double reference_norm_ = 0, round_off_ = 0, weight_[components] = {1, 1};
  Linearization at_;
  Balancing balance_;
  std::optional<Pattern> pattern_;  ///< with the matrix of the last linearization
  Teuchos::RCP<algebra::MultiVector> coordinates_;
  algebra::Solver solver_;
};

}  // namespace thixis::flow
