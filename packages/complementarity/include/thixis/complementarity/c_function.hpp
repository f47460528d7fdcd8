#pragma once
/// C-functions, C(x, y) = 0 <=> x >= 0, y >= 0, xy = 0, and their generalized derivatives, with x = K_l(X), y = s_l G_l(X), s_l > 0:
///
///     min:                 C = min(x, y)
///     Fischer–Burmeister:  C = √(x² + y²) - (x + y)        (its sign is opposite to that of min)
///
/// The contact rows of a semismooth Newton step are a_l K_l' + b_l G_l' with a = ∂C/∂K, b = ∂C/∂G (b contains s_l).
/// All vectors live on the map of the contact points. NaN or infinity in any argument of a point makes its C NaN or infinite.
#include "thixis/algebra/fwd.hpp"

namespace thixis::complementarity {

class ActiveSet;

enum class CFunction { min, fischer_burmeister };

/// C_l; overwrites C. With `min`, C_l = K_l at the points of the contact set `active` (see ActiveSet) and s_l G_l elsewhere: this is the
/// minimum up to the tie tolerance, and consistent with the row that `differentiate` chooses. Fischer–Burmeister does not read `active`
/// and avoids cancellation: -2xy/(√(x²+y²) + x + y) where x + y > 0.
void evaluate(CFunction function, const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s, const ActiveSet& active,
              algebra::Vector& C);

/// An element of the B-subdifferential of C, overwrites a and b:
///
///     min:                 (a, b) = (1, 0) at the points of the contact set, (0, s) elsewhere
///     Fischer–Burmeister:  (a, b) = (x/r - 1, s (y/r - 1)),  r = √(x²+y²);  at r = 0 always (1/√2 - 1) (1, s), its limit along x = y > 0.
///
/// a, b/s are in [-2, 0] for Fischer–Burmeister; where x > 0 they are computed as -(y/r) (y/(r + x)), exact also for tiny y.
void differentiate(CFunction function, const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s,
                   const ActiveSet& active, algebra::Vector& a, algebra::Vector& b);

}  // namespace thixis::complementarity
