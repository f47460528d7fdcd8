#pragma once
#include "problem/membrane_measure.hpp"
#include "thixis/contact/problem.hpp"

namespace thixis::membranes {

/// Membranes in contact as the nonlinear solver sees them: X = (u_1, …, u_m, lambda) in columns, G = lambda, K = u_1 - u_2 or u_1 - psi.
class MembraneProblem final : public contact::Problem {
 public:
  MembraneProblem(MembraneOperator membranes, const algebra::LinearParams& params, const algebra::Nodes& nodes);

  double noise(const algebra::Vector& X) const override;
  double gap_size(const algebra::Vector& X, const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s) const override;

  /// Takes the round-off of the linear solver out of a solution: lambda_l = 0 at free points, no gap at contact points (K_l <= s_l G_l), so
  /// that interpolation meets exact zeros.
  void settle(algebra::Vector& X) const;
  /// Makes X, extrapolated from `before`, complementary at every point: as settle, and what is below zero is cut. Points that were free
  /// before stay so, with half the gap that they had at least, unless the gap closes in the first half of the step: Newton-min adds points
  /// to the contact zone at once, but takes back a zone that is too large by one layer of points a step.
  void make_admissible(const algebra::Vector& before, algebra::Vector& X) const;
  /// Closes the gap (membranes: at the mean theta1 u1 + theta2 u2) where lambda_l > 0, for nodal multipliers. Interpolation leaves points
  /// along the edge of the contact zone with a gap and a multiplier; where the data are flat there, beginning with them free would make the
  /// zone overshoot, and Newton-min takes that back by one layer of points a step.
  void make_complementary(algebra::Vector& X) const;

  /// What residuals are measured by, from the loads that the operator has now; see MembraneMeasure::set. Collective.
  void measure_from(const Rest& rest, const Teuchos::RCP<algebra::Vector>* body = nullptr);
  const MembraneMeasure& measure() const { return measure_; }

  /// S_alpha <- the stiffness + weight M, M the mass of `space`, which must outlive this. Symbolic work is kept. Collective.
  void set_inertia(const method::Space& space, double weight);

  const MembraneOperator& membranes() const { return *membranes_; }  ///< whose loads may be overwritten

 private:
  MembraneProblem(const std::shared_ptr<MembraneOperator>& membranes, const algebra::LinearParams& params, const algebra::Nodes& nodes);
  MembraneProblem(const std::shared_ptr<MembraneOperator>& membranes, const MembraneMeasure& measure, const algebra::LinearParams& params,
                  const algebra::Nodes& nodes);

  std::shared_ptr<MembraneOperator> membranes_;
  MembraneMeasure measure_;
  std::unique_ptr<Inertia> inertia_;  ///< of scenes in time
};

}  // namespace thixis::membranes
