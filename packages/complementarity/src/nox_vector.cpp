#include "nox_vector.hpp"

#include <cmath>

namespace thixis::complementarity {
namespace {
const algebra::Vector& of(const NOX::Abstract::Vector& v) { return dynamic_cast<const NoxVector&>(v).values(); }
}  // namespace

NOX::Abstract::Vector& NoxVector::init(double gamma) {
  values_.putScalar(gamma);
  return *this;
}
NOX::Abstract::Vector& NoxVector::random(bool, int) {
  values_.randomize();
  return *this;
}
NOX::Abstract::Vector& NoxVector::abs(const NOX::Abstract::Vector& y) {
  values_.abs(of(y));
  return *this;
}
NOX::Abstract::Vector& NoxVector::operator=(const NOX::Abstract::Vector& y) {
  Tpetra::deep_copy(values_, of(y));
  return *this;
}
NoxVector& NoxVector::operator=(const NoxVector& y) {
  Tpetra::deep_copy(values_, y.values_);
  return *this;
}
NOX::Abstract::Vector& NoxVector::reciprocal(const NOX::Abstract::Vector& y) {
  values_.reciprocal(of(y));
  return *this;
}
NOX::Abstract::Vector& NoxVector::scale(double gamma) {
  values_.scale(gamma);
  return *this;
}
NOX::Abstract::Vector& NoxVector::scale(const NOX::Abstract::Vector& a) {
  values_.elementWiseMultiply(1, of(a), values_, 0);
  return *this;
}
NOX::Abstract::Vector& NoxVector::update(double alpha, const NOX::Abstract::Vector& a, double gamma) {
  values_.update(alpha, of(a), gamma);
  return *this;
}
NOX::Abstract::Vector& NoxVector::update(double alpha, const NOX::Abstract::Vector& a, double beta, const NOX::Abstract::Vector& b,
                                         double gamma) {
  values_.update(alpha, of(a), beta, of(b), gamma);
  return *this;
}
Teuchos::RCP<NOX::Abstract::Vector> NoxVector::clone(NOX::CopyType type) const {
  if (type == NOX::ShapeCopy) return Teuchos::rcp(new NoxVector(values_.getMap()));
  return Teuchos::rcp(new NoxVector(values_));
}
double NoxVector::norm(NOX::Abstract::Vector::NormType type) const {
  if (type == NOX::Abstract::Vector::OneNorm) return values_.norm1();
  if (type == NOX::Abstract::Vector::MaxNorm) return values_.normInf();
  return values_.norm2();
}
double NoxVector::norm(const NOX::Abstract::Vector& weights) const {
  algebra::Vector weighted(values_.getMap());
  weighted.elementWiseMultiply(1, of(weights), values_, 0);
  return std::sqrt(weighted.dot(values_));
}
double NoxVector::innerProduct(const NOX::Abstract::Vector& y) const { return values_.dot(of(y)); }
NOX::size_type NoxVector::length() const { return static_cast<NOX::size_type>(values_.getGlobalLength()); }

}  // namespace thixis::complementarity
