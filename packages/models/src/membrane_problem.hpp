#pragma once
#include "linearized_system.hpp"
#include "membrane_measure.hpp"
#include "projected_jacobi.hpp"
#include "thixis/complementarity/problem.hpp"

namespace thixis::models {

/// Membranes in contact as the nonlinear solver sees them: X = (u_1, …, u_m, lambda) interlaced by node, G = lambda, K = u_1 - u_2 or
/// u_1 - psi.
class MembraneProblem final : public complementarity::Problem {
 public:
  /// `coordinates`: of the nodes, map().
  MembraneProblem(MembraneOperator membranes, const algebra::LinearParams& params,
                  const Teuchos::RCP<const algebra::MultiVector>& coordinates);

  algebra::MapPtr map() const override { return map_; }
  algebra::MapPtr points() const override { return membranes_.points(); }
  void equations(const algebra::Vector& X, algebra::Vector& R) const override;
  void arguments(const algebra::Vector& X, algebra::Vector& K, algebra::Vector& G) const override;
  /// s_l = D_l sum_alpha 1/S_alpha,ll: how far a unit multiplier at l alone opens the gap there.
  void scaling(algebra::Vector& s) const override;
  void insert(const algebra::Vector& C, algebra::Vector& R) const override;
  void linearize(const algebra::Vector& X, const algebra::Vector& a, const algebra::Vector& b) override;
  algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) override;
  bool weights(algebra::Vector& w) const override;
  double reference_norm() const override { return measure_.reference(); }
  double noise(const algebra::Vector& X) const override;
  double gap_size(const algebra::Vector& X, const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s) const override;
  void relax(algebra::Vector& X, int sweeps) const override;

  /// Takes the round-off of the linear solver out of a solution: lambda_l = 0 at free points, no gap at contact points (K_l <= s_l G_l), so
  /// that interpolation meets exact zeros.
  void settle(Fields& x) const;
  /// Makes x, extrapolated from `before`, complementary at every point: as settle, and what is below zero is cut. Points that were free
  /// before stay so, with half the gap that they had at least, unless the gap closes in the first half of the step: Newton-min adds points
  /// to the contact zone at once, but takes back a zone that is too large by one layer of points a step.
  void make_admissible(const Fields& before, Fields& x) const;
  /// Closes the gap (membranes: at the mean theta1 u1 + theta2 u2) where lambda_l > 0, for nodal multipliers. Interpolation leaves points
  /// along the edge of the contact zone with a gap and a multiplier; where the data are flat there, beginning with them free would make the
  /// zone overshoot, and Newton-min takes that back by one layer of points a step.
  void make_complementary(Fields& x) const;

  /// What residuals are measured by, from the loads that the operator has now; see MembraneMeasure::set. Collective.
  void measure_from(const Rest& rest, const Teuchos::RCP<algebra::Vector>* body = nullptr) { measure_.set(membranes_, rest, body); }
  const MembraneMeasure& measure() const { return measure_; }

  /// S_alpha <- the stiffness + weight M, M the mass of `space`, which must outlive this. Symbolic work is kept. Collective.
  void set_inertia(const method::Space& space, double weight);

  const MembraneOperator& membranes() const { return membranes_; }  ///< whose loads may be overwritten
  GlobalIndex unknowns() const;                                     ///< all of X
  GlobalIndex rows() const;                                         ///< of the Krylov system
  GlobalIndex nonzeros() const;                                     ///< 0 before the first linearization

 private:
  MembraneOperator membranes_;
  MembraneMeasure measure_;
  algebra::LinearParams params_;
  Teuchos::RCP<const algebra::MultiVector> coordinates_;
  algebra::MapPtr map_;
  GlobalIndex interior_ = 0;                           ///< unknowns of each membrane that condensation eliminates
  mutable std::unique_ptr<ProjectedJacobi> smoother_;  ///< made where smoothing is asked for
  std::unique_ptr<Inertia> inertia_;                   ///< of scenes in time
  std::unique_ptr<LinearizedSystem> system_;           ///< made at the first linearization: a run that only counts pays nothing for it
};

}  // namespace thixis::models
