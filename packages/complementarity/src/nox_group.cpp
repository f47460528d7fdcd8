#include "nox_group.hpp"

namespace thixis::complementarity {

NoxGroup::NoxGroup(System& system, const algebra::Vector& X) : system_(system), X_(X), R_(X.getMap()) {}

NoxGroup::NoxGroup(const NoxGroup& other)
    : NOX::Abstract::Group(other), system_(other.system_), X_(other.X_), R_(other.R_), state_(other.state_), is_F_(other.is_F_) {}

NoxGroup& NoxGroup::operator=(const NoxGroup& other) {
  if (this == &other) return *this;
  forget();
  X_ = other.X_;
  if (other.is_F_) R_ = other.R_;
  state_ = other.state_;
  is_F_ = other.is_F_;
  return *this;
}
NOX::Abstract::Group& NoxGroup::operator=(const NOX::Abstract::Group& other) { return *this = dynamic_cast<const NoxGroup&>(other); }

void NoxGroup::forget() { is_F_ = is_jacobian_ = is_newton_ = false; }

void NoxGroup::setX(const NOX::Abstract::Vector& y) {
  forget();
  static_cast<NOX::Abstract::Vector&>(X_) = y;
}

void NoxGroup::computeX(const NOX::Abstract::Group& group, const NOX::Abstract::Vector& d, double step) {
  forget();
  X_.update(1, dynamic_cast<const NoxGroup&>(group).X_, step, d, 0);
  if (step != 1) system_.forget_estimate();
}

NOX::Abstract::Group::ReturnType NoxGroup::computeF() {
  if (!is_F_) system_.residual(X_.values(), R_.values(), state_);
  is_F_ = true;
  return Ok;
}

NOX::Abstract::Group::ReturnType NoxGroup::computeJacobian() {
  if (!is_F_) return BadDependency;
  if (!is_jacobian_) system_.linearize(X_.values(), state_.active);
  is_jacobian_ = true;
  return Ok;
}

NOX::Abstract::Group::ReturnType NoxGroup::computeNewton(Teuchos::ParameterList&) {
  if (is_newton_) return Ok;
  if (!is_F_ || !is_jacobian_) return BadDependency;
  if (newton_.is_null()) newton_ = Teuchos::rcp(new NoxVector(X_.values().getMap()));
  system_.solve(X_.values(), state_, R_.values(), newton_->values());
  is_newton_ = true;
  return Ok;
}

const NOX::Abstract::Vector& NoxGroup::getGradient() const {
  throw core::Error(core::ExitCode::internal, "The semismooth system has no gradient: its matrix can not be transposed.");
}

Teuchos::RCP<NOX::Abstract::Group> NoxGroup::clone(NOX::CopyType type) const {
  if (type == NOX::ShapeCopy) return Teuchos::rcp(new NoxGroup(system_, X_.values()));
  return Teuchos::rcp(new NoxGroup(*this));
}

}  // namespace thixis::complementarity
