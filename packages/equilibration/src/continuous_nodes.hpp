#pragma once
#include <array>
#include <vector>

#include "thixis/equilibration/cell_fields.hpp"
#include "thixis/method/polynomial_space.hpp"

namespace thixis::equilibration {

using CellEntries = Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>;

/// Coefficients of continuous P_p on some cells: one entry for each vertex, p-1 for each face, from its lower vertex id on, and those
/// inside; ids go from the vertices over the faces to the cells.
struct ContinuousNodes {
  method::Entries entries;
  CellEntries of_cells;  ///< (cell k, l) in the order of reference::CellBasis
};
/// `points`: the place of each function in the cell, flat [n][2]. Entries on faces with a tag of `dirichlet` are held by the lowest such
/// tag that this rank sees.
ContinuousNodes continuous_nodes(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const reference::CellBasis& basis,
                                 const std::vector<double>& points, const std::vector<bool>& dirichlet);

/// Where the values of a continuous function that `held` tags fix come from: values of the fields by tag, as coefficients. 0 elsewhere.
std::vector<double> boundary_coefficients(const method::PolynomialSpace& space, const ContinuousNodes& nodes,
                                          const std::vector<scene::FieldPtr>& by_tag);
/// Coefficients of the interpolant of a function.
std::vector<double> interpolant(const method::PolynomialSpace& space, const ContinuousNodes& nodes, const scene::Field& field);

}  // namespace thixis::equilibration
