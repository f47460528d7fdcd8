#pragma once
#include <functional>
#include <vector>

#include "thixis/method/graph.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

/// Unknowns as functionals of polynomials in cells. Coefficients of cells have one term, in the last cell that has the unknown; unknowns
/// on faces have one for each of their cells, and are the mean of them.
struct Terms {
  std::vector<LocalIndex> begin;  ///< terms of each unknown: begin[r] <= t < begin[r + 1]
  std::vector<LocalIndex> cell;   ///< its patch cell
  std::vector<int> place;         ///< its place i among the unknowns of the cell; -1 - i: with the other sign
};

/// Of the unknowns below `rows`. `elements`: (patch cell, i) -> unknown, of which the first `of_cell` are coefficients of the cell.
/// backwards(k, i): unknown i of patch cell k is minus its functional there.
Terms terms_of(const ElementUnknowns& elements, LocalIndex rows, int of_cell, const std::function<bool(LocalIndex, int)>& backwards);

/// (s, q, j): the q-th functional of the polynomial that the basis function j of the parent is in a child of shape s. The first ones are
/// its coefficients in the basis of the child, those of traces follow (Layout::trace_functionals).
using FunctionalsOfChildren = Kokkos::View<double***, Kokkos::LayoutRight>;
FunctionalsOfChildren functionals_of_children(const reference::CellBasis& parent, const reference::CellBasis& child,
                                              const std::vector<double>& traces);

}  // namespace thixis::method
