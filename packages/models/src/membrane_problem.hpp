#pragma once
#include "linearized_system.hpp"
#include "thixis/complementarity/problem.hpp"

namespace thixis::models {

/// The two-membrane problem as the nonlinear solver sees it: X = (u1, u2, lambda) interlaced by node, K_l = u1_l - u2_l, G_l = lambda_l.
class MembraneProblem final : public complementarity::Problem {
 public:
  MembraneProblem(MembraneOperator membranes, const algebra::LinearParams& params,
                  const Teuchos::RCP<const algebra::MultiVector>& coordinates);

  algebra::MapPtr map() const override { return map_; }
  algebra::MapPtr points() const override { return membranes_.map(); }
  void equations(const algebra::Vector& X, algebra::Vector& R) const override;
  void arguments(const algebra::Vector& X, algebra::Vector& K, algebra::Vector& G) const override;
  /// s_l = D_l (1/S1_ll + 1/S2_ll): how far apart a unit multiplier at l alone pushes the membranes there.
  void scaling(algebra::Vector& s) const override;
  void insert(const algebra::Vector& C, algebra::Vector& R) const override;
  void linearize(const algebra::Vector& X, const algebra::Vector& a, const algebra::Vector& b) override;
  algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) override;
  double reference_norm() const override;
  void relax(algebra::Vector& X, int sweeps) const override;

  /// Takes the round-off of the linear solver out of a solution: lambda_l = 0 at free points, no gap at contact points (K_l <= s_l G_l), so
  /// that interpolation meets exact zeros. x: columns u1, u2, lambda.
  void settle(algebra::MultiVector& x) const;
  /// Brings the membranes together (at the mean theta1 u1 + theta2 u2) where lambda_l > 0. Interpolation leaves points along the edge of
  /// the contact zone with a gap and a multiplier; where the data are flat there, beginning with them free would make the zone overshoot,
  /// and Newton-min takes that back by one layer of points a step. x: columns u1, u2, lambda.
  void make_complementary(algebra::MultiVector& x) const;

  double mean_tension(int alpha) const { return membranes_.tension[alpha]; }
  GlobalIndex rows() const;      ///< of the Krylov system
  GlobalIndex nonzeros() const;  ///< 0 before the first linearization

 private:
  MembraneOperator membranes_;
  algebra::LinearParams params_;
  Teuchos::RCP<const algebra::MultiVector> coordinates_;
  algebra::MapPtr map_;
  std::unique_ptr<LinearizedSystem> system_;  ///< made at the first linearization: a run that only counts pays nothing for it
};

}  // namespace thixis::models
