#pragma once
#include <memory>

#include "thixis/complementarity/problem.hpp"
#include "thixis/contact/linearized_system.hpp"
#include "thixis/contact/projected_jacobi.hpp"

namespace thixis::contact {

/// A contact problem as the nonlinear solver sees it: X in columns, G = lambda, K = k0 + Bᵀ u.
class Problem : public complementarity::Problem {
 public:
  /// Rows have the weight 1, and what acts is the load, until somebody who knows better says so. Collective.
  Problem(std::shared_ptr<const System> system, const algebra::LinearParams& params, const algebra::Nodes& nodes);

  algebra::MapPtr map() const override { return map_; }
  algebra::MapPtr points() const override { return gaps_map_; }
  void equations(const algebra::Vector& X, algebra::Vector& R) const override;
  void arguments(const algebra::Vector& X, algebra::Vector& K, algebra::Vector& G) const override;
  /// s = D / kappa, 1/kappa = (Bᵀ diag(S)^{-1} B): how far a unit multiplier at a point alone opens its gap.
  void scaling(algebra::Vector& s) const override;
  void insert(const algebra::Vector& C, algebra::Vector& R) const override;
  void linearize(const algebra::Vector& X, const algebra::Vector& a, const algebra::Vector& b) override;
  algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) override;
  bool weights(algebra::Vector& w) const override;
  double reference_norm() const override { return reference_; }
  void relax(algebra::Vector& X, int sweeps) const override;
  void look_at(const algebra::Vector& Xi, const algebra::Vector& R) const override;
  void look_away() const override { shown_ = nullptr; }

  const System& system() const { return *system_; }  ///< whose loads may be overwritten
  GlobalIndex unknowns() const;                      ///< all of X
  GlobalIndex rows() const;                          ///< of the linear systems, all together
  GlobalIndex nonzeros() const;                      ///< 0 before the first linearization

 protected:
  Problem(std::shared_ptr<const System> system, Weights weights, double reference, const algebra::LinearParams& params,
          const algebra::Nodes& nodes);
  /// What the rows are measured by, and the size of what acts, as a residual.
  void measure_by(Weights weights, double reference);
  /// The values of the operator's matrices have changed; weights come anew by measure_by.
  void renew();

 private:
  bool full() const { return params_.form == algebra::SystemForm::full && !system_->S.cells; }

  std::shared_ptr<const System> system_;
  Weights weights_;
  double reference_;
  algebra::LinearParams params_;
  algebra::Nodes nodes_;
  algebra::MapPtr map_, gaps_map_;
  GlobalIndex left_;  ///< unknowns of the fields that condensation does not eliminate
  Teuchos::RCP<algebra::MultiVector> product_;
  mutable std::unique_ptr<ProjectedJacobi> smoother_;  ///< made where smoothing is asked for
  mutable const algebra::Vector* shown_ = nullptr;     ///< the iterate that is looked at
  mutable Teuchos::RCP<algebra::Vector> shown_residual_;
  std::unique_ptr<LinearizedSystem> linearized_;  ///< made at the first linearization: a run that only counts pays nothing for it
};

}  // namespace thixis::contact
