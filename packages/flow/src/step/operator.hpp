#pragma once
#include "step/scene_on_grid.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::flow {

/// Two-phase flow on a grid of two-point fluxes: states, fluxes and masses of the cells from X, which holds (s_g, P, chi) of each owned
/// cell. Nothing here depends on the step.
class TwoPhaseOperator {
 public:
  /// Throws InputError for parts of the boundary that the grid does not have. Collective.
  TwoPhaseOperator(fv::Grid grid, const TwoPhaseScene& scene, double seconds_per_unit);

  const fv::Grid& grid() const { return grid_; }
  const TwoPhaseLaws& laws() const { return laws_; }
  const algebra::MapPtr& cells() const { return cells_; }            ///< owned cells
  const algebra::MapPtr& map() const { return map_; }                ///< of X: 3 cell + 0, 1, 2
  const algebra::MapPtr& column_map() const { return column_map_; }  ///< likewise, with the ghosts, in the order of the local cells
  const fv::View<FlowBoundaryKind*>& face_kind() const { return scene_.face_kind(); }  ///< no_flow inside

  /// The state of the scene at time 0 at the centres of the cells.
  Teuchos::RCP<algebra::Vector> initial() const;
  /// Throws InputError where the states on the boundary can not be at time t. Collective.
  void check(double t) const { scene_.check(t); }
  /// The step of ]begin, end] (units of the deck) from X^{n-1}: rates at its midpoint, states on the boundary at its end. Collective.
  FlowStep step(double begin, double end, const algebra::Vector& before) const;

  /// X on column_map(). Collective.
  algebra::Vector with_ghosts(const algebra::Vector& X) const;
  /// Of all local cells, ghosts included. Collective.
  fv::View<PhaseState*> states(const algebra::Vector& X) const;
  /// Of the owned cells, overwritten.
  void set_masses(const fv::View<PhaseState*>& states, const fv::View<double* [components]>& masses) const;
  /// Of all local faces: what they leave out of balance in a cell [kg/s] is
  /// R_c = |K| (l_c - before + owed)/length + sum_F ± |F| Phi_c - |K| source, ± outward.
  fv::View<FaceFlux*> fluxes(const fv::View<PhaseState*>& states, const FlowStep& step) const;

 private:
  fv::Grid grid_;
  TwoPhaseLaws laws_;
  SceneOnGrid scene_;
  algebra::MapPtr cells_, map_, column_map_;
  Teuchos::RCP<const algebra::Import> import_;
};

}  // namespace thixis::flow
