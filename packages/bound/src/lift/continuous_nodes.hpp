#pragma once
#include <vector>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/continuous_nodes.hpp"
#include "thixis/method/jumps.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

using method::continuous_nodes;
using method::ContinuousNodes;
using CellEntries = Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>;

/// Where the values of a continuous function that `held` tags fix come from: values of the fields by tag, as coefficients. 0 elsewhere.
std::vector<double> boundary_coefficients(const method::Space& space, const ContinuousNodes& nodes,
                                          const std::vector<scene::FieldPtr>& by_tag, double time);
/// The coefficients of an obstacle that the contact points see: psi_I. `jumps`: by patch cell.
std::vector<double> obstacle_coefficients(const method::Space& space, const ContinuousNodes& nodes, const scene::Field& psi,
                                          const method::Jumps& jumps);
/// A continuous function above an obstacle where that jumps: linear in these cells, each of their vertices having the highest value of
/// those around it; elsewhere psi_I but for the nodes that they share. `psi`: psi_I, `above`: what it is not to exceed at held nodes.
std::vector<double> majorant(const method::Space& space, const ContinuousNodes& nodes, const method::Jumps& jumps,
                             const std::vector<double>& psi, const std::vector<double>& above);

}  // namespace thixis::bound
