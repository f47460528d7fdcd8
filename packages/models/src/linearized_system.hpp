#pragma once
#include <memory>

#include "membrane_operator.hpp"
#include "thixis/algebra/solver.hpp"

namespace thixis::models {

/// One form of the linear system of a Newton step; for two membranes, and for one over an obstacle,
///
///     [ S1 0 -D ; 0 S2 D ; a -a b ] (d1, d2, dlambda) = -(R1, R2, C),        [ S -D ; a b ] (d, dlambda) = -(R, C).
class LinearizedSystem {
 public:
  virtual ~LinearizedSystem() = default;
  virtual void linearize(const algebra::Vector& a, const algebra::Vector& b) = 0;
  virtual algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) = 0;
  /// The values of the operator's matrices have changed; its loads may change at any time.
  virtual void renew() {}
  virtual GlobalIndex nonzeros() const = 0;
};

}  // namespace thixis::models
