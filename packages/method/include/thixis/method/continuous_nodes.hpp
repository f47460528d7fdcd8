#pragma once
#include <Kokkos_Core.hpp>
#include <vector>

#include "thixis/mesh/mesh.hpp"
#include "thixis/method/numbering.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

/// Coefficients of continuous P_p on some cells, in the order in which the cells meet them: one entry for each vertex, p-1 for each face,
/// from its lower to its higher vertex id, and those inside each cell; ids go from the vertices over the faces to the cells.
struct ContinuousNodes {
  Entries entries;
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> of_cells;  ///< (cell k, l) in the order of reference::CellBasis
};

/// `points`: the place of each function in the cell, flat [n][2]. Entries on faces with a tag of `dirichlet` are held by the lowest such
/// tag that this rank sees.
ContinuousNodes continuous_nodes(const mesh::Mesh& mesh, const mesh::View<const LocalIndex*>& cells, const reference::CellBasis& basis,
                                 const std::vector<double>& points, const std::vector<bool>& dirichlet);

}  // namespace thixis::method
