#pragma once
#include <vector>

#include "thixis/equilibration/cell_fields.hpp"

namespace thixis::equilibration {

/// The pieces of a whole mesh that nothing holds: of every cell the number of its piece, -1 if that is held.
struct FreePieces {
  std::vector<int> of_cell;
  std::vector<double> area;
  std::vector<LocalIndex> vertex;  ///< one of each piece

  FreePieces(const mesh::Mesh& mesh, const std::vector<bool>& held, const Metrics& metric);
  /// r without its means on these pieces; the norm of what it loses.
  double take_means(const CellTable& r, const Metrics& metric) const;
};

}  // namespace thixis::equilibration
