#pragma once
#include <vector>

#include "thixis/equilibration/cell_fields.hpp"
#include "thixis/method/continuous_nodes.hpp"
#include "thixis/method/polynomial_space.hpp"

namespace thixis::equilibration {

using method::continuous_nodes;
using method::ContinuousNodes;
using CellEntries = Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>;

/// Where the values of a continuous function that `held` tags fix come from: values of the fields by tag, as coefficients. 0 elsewhere.
std::vector<double> boundary_coefficients(const method::PolynomialSpace& space, const ContinuousNodes& nodes,
                                          const std::vector<scene::FieldPtr>& by_tag, double time);
/// Coefficients of the interpolant of a function.
std::vector<double> interpolant(const method::PolynomialSpace& space, const ContinuousNodes& nodes, const scene::Field& field);

}  // namespace thixis::equilibration
