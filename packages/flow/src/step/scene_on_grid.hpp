#pragma once
#include <map>

#include "step/places.hpp"

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

/// What a scene says of a grid: states and rates at the centres of cells and the midpoints of faces of the boundary.
class SceneOnGrid {
 public:
  /// Throws InputError for parts of the boundary that the grid does not have.
  SceneOnGrid(const fv::Grid& grid, const TwoPhaseScene& scene, const TwoPhaseLaws& laws, double seconds_per_unit);

  double seconds_per_unit() const { return seconds_per_unit_; }
  const fv::View<FlowBoundaryKind*>& face_kind() const { return face_kind_; }  ///< no_flow inside
  /// The state at time 0 in the owned cells. Throws InputError where it can not be. Collective.
  StateValues initial() const;
  /// Throws InputError where the states on the boundary can not be at time t. Collective.
  void check(double t) const;
  /// Sets source, inflow and outside of ]begin, end] (units of the deck): rates at its midpoint, states at its end. Collective.
  void set_data(double begin, double end, FlowStep& step) const;

 private:
  void set_rates(const scene::FieldPtr& field, const Places& places, double t, Component c,
                 const fv::View<double* [components]>& rates) const;
  void set_states(const std::string& tag, double t, const fv::View<PhaseState*>& outside) const;

  core::Comm comm_;
  TwoPhaseScene scene_;
  TwoPhaseLaws laws_;
  double seconds_per_unit_;
  Places cells_;
  std::map<std::string, Places> parts_;  ///< of the boundary, by tag
  fv::View<FlowBoundaryKind*> face_kind_;
};

}  // namespace thixis::flow
