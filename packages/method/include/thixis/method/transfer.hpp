#pragma once
#include "thixis/method/space.hpp"

namespace thixis::method {

/// P from a space on a mesh to the space of the same method and degree on the next finer mesh, as an operator in kernels: a function of the
/// coarse space, a polynomial in every parent, is restricted to the children, and
///
///     (P u)_r = the coefficient r of that in one of the cells of r; for unknowns on faces (Layout::trace_functionals) the mean over both.
///
/// Where functions are continuous, the restriction lies in the fine space. Curved charts: children are taken as they lie in the parameter
/// domain.
class Transfer {
 public:
  /// Both spaces must outlive it. Collective.
  Transfer(const Space& coarse, const Space& fine);
  ~Transfer();
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  /// fine <- P coarse and coarse <- Pᵀ fine, on the unknowns: Dirichlet values are 0. Collective.
  void apply(const algebra::Vector& coarse, algebra::Vector& fine) const;
  void apply_transpose(const algebra::Vector& fine, algebra::Vector& coarse) const;
  /// The same with the Dirichlet values that u has. Collective.
  void prolongate(const Coefficients& coarse_u, algebra::Vector& fine_u) const;
  /// X3 of the function lambda_h of the coarse space (Space::multiplier). Scalar spaces. Collective.
  void multiplier(const algebra::Vector& coarse_X3, algebra::Vector& fine_X3) const;

  std::size_t bytes() const;  ///< held for the mesh on this rank

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::method
