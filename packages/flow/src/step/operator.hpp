#pragma once
#include "laws/laws.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/fv/grid.hpp"

namespace thixis::flow {

/// A step of backward Euler as kernels see it, in SI units.
struct FlowStep {
  double length = 0;                      ///< s
  fv::View<PhaseState*> states_before;    ///< of all local cells at its beginning
  fv::View<double* [components]> before;  ///< masses of the owned cells there, as in Masses
  fv::View<double* [components]> owed;    ///< by how much these masses exceed what has come into the cell so far [kg/m^3]
  fv::View<double* [components]> source;  ///< of the owned cells [kg/(m^3 s)]
  fv::View<double* [components]> inflow;  ///< of the faces of kind flux, into the domain [kg/(m^2 s)]
  fv::View<PhaseState*> outside;          ///< of the faces of kind state
};

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
  const fv::View<FlowBoundaryKind*>& face_kind() const { return face_kind_; }  ///< no_flow inside

  /// The state of the scene at time 0 at the centres of the cells.
  Teuchos::RCP<algebra::Vector> initial() const;
  /// Throws InputError where the states on the boundary can not be at time t. Collective.
  void check(double t) const;
  /// The step of ]begin, end] (units of the deck) from X^{n-1}: rates at its midpoint, states on the boundary at its end. Collective.
  FlowStep step(double begin, double end, const algebra::Vector& before) const;

  /// X on column_map(). Collective.
  algebra::Vector with_ghosts(const algebra::Vector& X) const;
  /// Of all local cells, ghosts included. Collective.
  fv::View<PhaseState*> states(const algebra::Vector& X) const;
  /// Of all local faces: what they leave out of balance in a cell [kg/s] is
  /// R_c = |K| (l_c - before + owed)/length + sum_F ± |F| Phi_c - |K| source, ± outward.
  fv::View<FaceFlux*> fluxes(const fv::View<PhaseState*>& states, const FlowStep& step) const;

 private:
  void set_boundary(const TwoPhaseScene& scene);

  fv::Grid grid_;
  TwoPhaseScene scene_;
  double seconds_per_unit_;
  TwoPhaseLaws laws_;
  algebra::MapPtr cells_, map_, column_map_;
  Teuchos::RCP<const algebra::Import> import_;
  fv::View<FlowBoundaryKind*> face_kind_;
};

}  // namespace thixis::flow
