#pragma once
#include <Kokkos_Core.hpp>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::method {

/// Sums over cells by name: `Names` is a struct with an unscoped enumeration whose last entry is `count`.
template <class Names>
struct Sums {
  double of[Names::count] = {};

  KOKKOS_INLINE_FUNCTION double& operator[](int name) { return of[name]; }
  KOKKOS_INLINE_FUNCTION double operator[](int name) const { return of[name]; }
  KOKKOS_INLINE_FUNCTION Sums& operator+=(const Sums& other) {
    for (int name = 0; name < Names::count; ++name) of[name] += other.of[name];
    return *this;
  }
  /// Over all ranks. Collective.
  Sums over(const core::Comm& comm) const {
    std::vector<double> values(of, of + Names::count);
    comm.sum(values);
    Sums all;
    for (int name = 0; name < Names::count; ++name) all.of[name] = values[name];
    return all;
  }
};

}  // namespace thixis::method

template <class Names>
struct Kokkos::reduction_identity<thixis::method::Sums<Names>> {
  KOKKOS_FORCEINLINE_FUNCTION static thixis::method::Sums<Names> sum() { return {}; }
};

namespace thixis::method {

/// The sums of kernel(K, sums) over the owned cells of this rank.
template <class Names, class Kernel>
Sums<Names> sum_over_cells(const char* label, LocalIndex cells, const Kernel& kernel) {
  Sums<Names> sums;
  Kokkos::parallel_reduce(label, Kokkos::RangePolicy<>(0, cells), kernel, Kokkos::Sum<Sums<Names>>(sums));
  return sums;
}

}  // namespace thixis::method
