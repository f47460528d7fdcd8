#pragma once
#include <memory>
#include <vector>

#include "lift/continuous_nodes.hpp"
#include "lift/lift_rule.hpp"
#include "thixis/algebra/solver.hpp"

namespace thixis::bound {

/// (mu grad v, grad w) = -(mu grad l, grad w) for all w like v: continuous, of degree 4, in a layer of cells along the held boundary, 0 on
/// it and on the rim of the layer. Assembled as any equation of `method` is; only its layout is its own.
class LiftEquations {
 public:
  /// `layer`: cells, the owned ones first; `basis`: of v. Collective; throws InputError where a tension is not positive.
  LiftEquations(const method::Space& space, const View<const LocalIndex*>& layer, const reference::CellBasis& basis,
                const std::vector<bool>& dirichlet, const std::array<scene::FieldPtr, 2>& tension, int count);
  ~LiftEquations();
  LiftEquations(const LiftEquations&) = delete;
  LiftEquations& operator=(const LiftEquations&) = delete;

  /// Sets v of membrane alpha in the first `owned` cells of the layer; l in all of them is given. Collective.
  void solve(int alpha, LocalIndex owned, std::vector<LiftInCell>& lift) const;

 private:
  /// Holds the nodes on the rim: on faces whose other cell is outside of the layer. Owners of nodes have all their cells.
  void hold_rim(const method::Space& space, method::ContinuousNodes& nodes) const;

  mesh::HostMesh host_;
  View<const LocalIndex*> layer_;
  reference::CellBasis basis_;
  bool constant_;  ///< v does not depend on constant tensions: one matrix for both
  LiftRule rule_;
  LiftRule::Derivatives derivatives_;  ///< at the points of the rule
  method::Numbering numbering_;
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> elements_;  ///< (layer cell, i) -> column
  algebra::GraphPtr graph_;
  std::unique_ptr<algebra::Solver> solver_[2];
};

}  // namespace thixis::bound
