#pragma once
#include <NOX_Abstract_Group.H>

#include "nox_vector.hpp"
#include "system.hpp"

namespace thixis::complementarity {

/// An iterate with its residual and Newton direction, for NOX. All groups of a run share one `System`, and with it the linearization:
/// only the group that computed it last has it.
class NoxGroup : public NOX::Abstract::Group {
 public:
  NoxGroup(System& system, const algebra::Vector& X);
  NoxGroup(const NoxGroup& other);
  NoxGroup& operator=(const NoxGroup& other);
  NOX::Abstract::Group& operator=(const NOX::Abstract::Group& other) override;

  const algebra::Vector& X() const { return X_.values(); }
  const State& state() const { return state_; }  ///< valid if isF()

  void setX(const NOX::Abstract::Vector& y) override;
  void computeX(const NOX::Abstract::Group& group, const NOX::Abstract::Vector& d, double step) override;
  ReturnType computeF() override;
  ReturnType computeJacobian() override;
  /// Throws StepFailed.
  ReturnType computeNewton(Teuchos::ParameterList& parameters) override;

  bool isF() const override { return is_F_; }
  bool isJacobian() const override { return is_jacobian_; }
  bool isNewton() const override { return is_newton_; }
  const NOX::Abstract::Vector& getX() const override { return X_; }
  const NOX::Abstract::Vector& getF() const override { return R_; }
  double getNormF() const override { return state_.residual; }
  const NOX::Abstract::Vector& getGradient() const override;  ///< not provided: throws
  const NOX::Abstract::Vector& getNewton() const override { return *newton_; }
  Teuchos::RCP<const NOX::Abstract::Vector> getXPtr() const override { return Teuchos::rcpFromRef(X_); }
  Teuchos::RCP<const NOX::Abstract::Vector> getFPtr() const override { return Teuchos::rcpFromRef(R_); }
  Teuchos::RCP<const NOX::Abstract::Vector> getGradientPtr() const override { return Teuchos::null; }
  Teuchos::RCP<const NOX::Abstract::Vector> getNewtonPtr() const override { return newton_; }
  Teuchos::RCP<NOX::Abstract::Group> clone(NOX::CopyType type) const override;

 private:
  void forget();

  System& system_;
  NoxVector X_, R_;
  Teuchos::RCP<NoxVector> newton_;
  State state_;
  bool is_F_ = false, is_jacobian_ = false, is_newton_ = false;
};

}  // namespace thixis::complementarity
