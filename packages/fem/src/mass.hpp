#pragma once
#include <memory>

#include "thixis/algebra/solver.hpp"
#include "thixis/method/space.hpp"

namespace thixis::fem {

/// The mass matrix M_lm = (psi_l, psi_m) of **all** nodes of a scalar space, boundary included: it turns moments into the function lambda_h
/// that has them, lambda_h = sum_l X3_l Theta_l with (Theta_l, psi_m) = delta_lm.
class Mass {
 public:
  /// The space must outlive it. Collective.
  explicit Mass(const method::Space& space);
  ~Mass();
  /// Coefficients of lambda_h at all entries, ghosts included, from the moments X3 at the unknowns; those at held nodes are 0. Collective.
  method::Coefficients solve(const algebra::Vector& X3) const;

 private:
  const method::Space& space_;
  mesh::View<LocalIndex*> entry_of_column_;
  algebra::MatrixPtr M_;
  std::unique_ptr<algebra::Solver> solver_;
};

}  // namespace thixis::fem
