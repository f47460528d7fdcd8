#pragma once
#include <stdexcept>
#include <string>

#include "thixis/algebra/solver.hpp"

namespace thixis::algebra {

/// The set-up of a preconditioner or factorization failed, on all ranks; what() is the clause that becomes LinearReport::reason.
struct Breakdown : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An approximation of A^{-1} as an operator.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// Collective. Numeric set-up for the values of A; symbolic, too, if the graph is another one than last time. Throws Breakdown.
  virtual void set_matrix(const Teuchos::RCP<const Matrix>& A, int fields, const Nodes& nodes) = 0;
  virtual Teuchos::RCP<const Operator> inverse() const = 0;
  virtual int symbolic_setups() const = 0;
};

/// A way to solve A x = b. A and b are finite and have at least one row.
class Method {
 public:
  virtual ~Method() = default;
  /// Collective. `inverse` is the preconditioner; null: the identity. Throws Breakdown.
  virtual void set_matrix(const Teuchos::RCP<const Matrix>& A, const Teuchos::RCP<const Operator>& inverse) = 0;
  /// Collective. Starts from x and overwrites it. If the report's residual, |b - A x|, is not finite, x is not, either.
  virtual LinearReport solve(const Vector& b, Vector& x, const LinearStop& stop) = 0;
  virtual int symbolic_setups() const { return 0; }
};

}  // namespace thixis::algebra
