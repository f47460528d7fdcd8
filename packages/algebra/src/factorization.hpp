#pragma once
#include <memory>

#include "method.hpp"

namespace thixis::algebra {

/// A = L U with pivoting (KLU2), computed and kept on rank 0: Amesos2's KLU2 of Trilinos 13.2 gives wrong solutions on several ranks.
/// As an operator it is A^{-1}.
class Factorization {
 public:
  Factorization();
  ~Factorization();

  /// Collective. Throws Breakdown if A is singular to working precision.
  void set_matrix(const Teuchos::RCP<const Matrix>& A);
  /// Collective. x <- A^{-1} b, for one column.
  void solve(const Vector& b, Vector& x) const;
  int symbolic_setups() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::algebra
