#pragma once
#include <Kokkos_Core.hpp>

namespace thixis::bound {

KOKKOS_INLINE_FUNCTION double squared(double x) { return x * x; }
KOKKOS_INLINE_FUNCTION double root(double square) { return Kokkos::Experimental::sqrt(square); }
KOKKOS_INLINE_FUNCTION double magnitude(double x) { return x < 0 ? -x : x; }

}  // namespace thixis::bound
