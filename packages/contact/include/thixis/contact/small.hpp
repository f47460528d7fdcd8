#pragma once
#include <Kokkos_Macros.hpp>

namespace thixis::contact {

constexpr int most_fields = 3;    ///< that kernels hold in registers
constexpr int most_matrices = 4;  ///< of which the blocks of an operator are made

/// A matrix over fields, coordinates or gaps, small enough for kernels to carry.
struct Small {
  double entry[most_fields][most_fields] = {};
  KOKKOS_INLINE_FUNCTION double operator()(int i, int j) const { return entry[i][j]; }
  KOKKOS_INLINE_FUNCTION double& operator()(int i, int j) { return entry[i][j]; }
};

}  // namespace thixis::contact
