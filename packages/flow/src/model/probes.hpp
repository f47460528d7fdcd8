#pragma once
#include <array>
#include <vector>

#include "laws/laws.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/fv/grid.hpp"
#include "thixis/models/model.hpp"

namespace thixis::flow {

/// The cells in which a run is looked at.
class TwoPhaseProbes {
 public:
  /// `points` empty: the cell whose centre is the leftmost one, the lowest of those. Throws InputError for a point outside of the mesh.
  /// Collective.
  TwoPhaseProbes(const fv::Grid& grid, const std::vector<models::Probe>& points);

  int count() const { return static_cast<int>(cell_.size()); }
  /// The unknowns there, on all ranks. Collective.
  std::vector<std::array<double, unknowns_per_cell>> operator()(const algebra::Vector& X) const;

 private:
  core::Comm comm_;
  std::vector<LocalIndex> cell_;  ///< of this rank; -1: on another one
};

}  // namespace thixis::flow
