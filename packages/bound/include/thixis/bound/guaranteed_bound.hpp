#pragma once
#include <memory>
#include <string>
#include <vector>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/bound/contact_problem.hpp"
#include "thixis/complementarity/estimate.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// The bound on the energy error of an iterate and its parts (docs/methods/estimates.md): with fluxes sigma_alpha in equilibrium
/// with f_alpha and a multiplier lambda^ >= 0, and a feasible pair s,
///
///     |||u - u_h|||² <= sum_K sum_alpha (|mu^{1/2} grad u_h + mu^{-1/2} sigma_alpha|_K + eta_osc)² + |||s - u_h|||² + 2 (lambda^, s_1 -
///     s_2).
class GuaranteedBound {
 public:
  /// What the mesh needs is set up here. The space and the hierarchy must outlive it. Collective.
  GuaranteedBound(const method::Space& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level);
  ~GuaranteedBound();
  GuaranteedBound(const GuaranteedBound&) = delete;
  GuaranteedBound& operator=(const GuaranteedBound&) = delete;

  /// Collective.
  complementarity::Estimate operator()(const Iterate& iterate);

  /// Of the last iterate, on the owned cells.
  struct CellParts {
    View<double*> discretization, linearization, algebraic;
  };
  const CellParts& cells() const;

  /// What keeps the last bound from being guaranteed, a clause each.
  std::vector<std::string> doubts() const;

  /// The fluxes of the last iterate, for tests: all three parts of membrane alpha, and what they are in equilibrium with.
  struct Fluxes {
    CellTable discretization, linearization, algebraic;    ///< (owned cell, 2 dim P_{q+1})
    CellTable density;                                     ///< (owned cell, dim P_q): of f - (-1)^alpha lambda
    CellTable residual_linearization, residual_algebraic;  ///< (owned cell, dim P_q)
  };
  Fluxes fluxes(int alpha) const;
  int flux_degree() const;  ///< q

  std::size_t bytes() const;  ///< held for the mesh

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::bound
