#pragma once
#include "step/operator.hpp"

namespace thixis::flow {

/// Where the entries of the Jacobian are. The rows of a cell hold itself and its neighbours across faces, in the order of their local
/// indices; that of contact itself alone.
struct Pattern {
  fv::View<LocalIndex*> row_begin;  ///< where the rows of a cell begin in the matrix; behind the last one all end
  fv::View<LocalIndex*> own;        ///< place of the cell among itself and its neighbours
  fv::View<LocalIndex*> place;      ///< of the neighbour across each entry of Grid::cell_faces; -1 on the boundary
  algebra::MatrixPtr matrix;

  /// Collective.
  explicit Pattern(const TwoPhaseOperator& flow);
};

}  // namespace thixis::flow
