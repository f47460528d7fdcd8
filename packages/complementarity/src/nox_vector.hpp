#pragma once
#include <NOX_Abstract_Vector.H>

#include "views.hpp"

namespace thixis::complementarity {

/// A Tpetra vector for NOX.
class NoxVector : public NOX::Abstract::Vector {
 public:
  explicit NoxVector(const algebra::MapPtr& map) : values_(map) {}
  explicit NoxVector(const algebra::Vector& values) : values_(values, Teuchos::Copy) {}
  NoxVector(const NoxVector& other) : NOX::Abstract::Vector(other), values_(other.values_, Teuchos::Copy) {}

  algebra::Vector& values() { return values_; }
  const algebra::Vector& values() const { return values_; }

  NOX::Abstract::Vector& init(double gamma) override;
  NOX::Abstract::Vector& random(bool use_seed, int seed) override;
  NOX::Abstract::Vector& abs(const NOX::Abstract::Vector& y) override;
  NOX::Abstract::Vector& operator=(const NOX::Abstract::Vector& y) override;
  NoxVector& operator=(const NoxVector& y);
  NOX::Abstract::Vector& reciprocal(const NOX::Abstract::Vector& y) override;
  NOX::Abstract::Vector& scale(double gamma) override;
  NOX::Abstract::Vector& scale(const NOX::Abstract::Vector& a) override;
  NOX::Abstract::Vector& update(double alpha, const NOX::Abstract::Vector& a, double gamma) override;
  NOX::Abstract::Vector& update(double alpha, const NOX::Abstract::Vector& a, double beta, const NOX::Abstract::Vector& b,
                                double gamma) override;
  Teuchos::RCP<NOX::Abstract::Vector> clone(NOX::CopyType type) const override;
  double norm(NOX::Abstract::Vector::NormType type) const override;
  double norm(const NOX::Abstract::Vector& weights) const override;
  double innerProduct(const NOX::Abstract::Vector& y) const override;
  NOX::size_type length() const override;

 private:
  algebra::Vector values_;
};

}  // namespace thixis::complementarity
