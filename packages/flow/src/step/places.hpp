#pragma once
#include <string>
#include <vector>

#include "laws/laws.hpp"
#include "thixis/fv/grid.hpp"

namespace thixis::flow {

/// Places where functions of a scene are asked for: the centres of the owned cells, or midpoints of faces.
struct Places {
  fv::View<LocalIndex*> index;  ///< of the cell or face
  std::vector<double> x, y;

  LocalIndex count() const { return index.extent_int(0); }
  /// 0 where there is no function.
  fv::View<double*> values(const scene::FieldPtr& field, double t) const;
};

Places centres(const fv::Grid& grid);
/// The faces of the boundary that lie in a group (mesh::is_in_group).
Places part_of_boundary(const fv::Grid& grid, const std::string& name);

/// The values of a state at places.
struct StateValues {
  fv::View<double*> s_g, P, chi;
};

/// The state of a scene there. Throws InputError for values that are no state, on this rank only; `path`: what they are below scene/flow.
StateValues states_at(const FlowState& state, const TwoPhaseLaws& laws, const Places& places, double t, const std::string& path);

}  // namespace thixis::flow
