#include "thixis/method/worst_cells.hpp"

#include <algorithm>
#include <cmath>

namespace thixis::method {
namespace {

struct Relations {
  PartsOfCells of;
  double least;
  KOKKOS_FUNCTION void operator()(int K, double& algebraic, double& linearization) const {
    const double disc = of.discretization(K), lin = of.linearization(K), alg = of.algebraic(K), compared = disc > least ? disc : least;
    const double of_alg = alg > 0 ? alg / (compared > lin ? compared : lin) : 0, of_lin = lin > 0 ? lin / compared : 0;
    algebraic = of_alg > algebraic ? of_alg : algebraic;
    linearization = of_lin > linearization ? of_lin : linearization;
  }
};

}  // namespace

WorstCells worst_cells(const PartsOfCells& of, double discretization, GlobalIndex global_cells, const core::Comm& comm) {
  const Relations kernel{of, 1e-3 * discretization / std::sqrt(static_cast<double>(global_cells))};
  std::vector<double> worst(2, 0.0);
  Kokkos::parallel_reduce("thixis::method::worst_cells", Kokkos::RangePolicy<>(0, of.discretization.extent_int(0)), kernel,
                          Kokkos::Max<double>(worst[0]), Kokkos::Max<double>(worst[1]));
  comm.max(worst);
  return {std::max(worst[0], 0.0), std::max(worst[1], 0.0)};
}

}  // namespace thixis::method
