#pragma once
#include "thixis/algebra/fwd.hpp"
#include "thixis/method/space.hpp"

/// Vectors at the contact points of a space, which are its first unknowns.
namespace thixis::bound {

/// Values at contact points, 0 at other unknowns.
algebra::Vector at_unknowns(const method::Space& space, const algebra::Vector& at_points);

/// above = D_l max(X3_l, 0), on the contact points; below = -D_l min(X3_l, 0) at those of the unknowns that are contact points, the others
/// are kept.
void split_multiplier(const method::Space& space, const algebra::Vector& X3, algebra::Vector& above, algebra::Vector& below);

/// M_l max(K_l, 0) at contact points, 0 at other unknowns.
algebra::Vector contact_products(const method::Space& space, const algebra::Vector& M, const algebra::Vector& K);

}  // namespace thixis::bound
