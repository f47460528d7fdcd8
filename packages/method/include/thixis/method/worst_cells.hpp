#pragma once
#include "thixis/mesh/mesh.hpp"

namespace thixis::method {

/// Parts of a bound in the owned cells of a rank.
struct PartsOfCells {
  mesh::View<const double*> discretization, linearization, algebraic;
};

/// The worst relations of parts in a cell.
struct WorstCells {
  double algebraic = 0;      ///< to the larger one of the others
  double linearization = 0;  ///< to the discretization
};

/// Over the cells of all ranks. Where next to nothing happens, or the solution is exact, there is no discretization error to compare with:
/// a thousandth of the mean one, `discretization` over the root of the number of cells, stands in for it. Collective.
WorstCells worst_cells(const PartsOfCells& of, double discretization, GlobalIndex global_cells, const core::Comm& comm);

}  // namespace thixis::method
