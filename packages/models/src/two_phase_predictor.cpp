#include "two_phase_predictor.hpp"

#include "two_phase_estimate_kernels.hpp"

namespace thixis::models {

Teuchos::RCP<algebra::Vector> predicted(const TwoPhaseOperator& flow, const algebra::Vector& X, const algebra::Vector& X_before,
                                        double ratio) {
  using Range = Kokkos::RangePolicy<algebra::Vector::execution_space>;
  const auto out = Teuchos::rcp(new algebra::Vector(X, Teuchos::Copy));
  out->update(-ratio, X_before, 1 + ratio);
  const auto x = out->getLocalViewDevice(Tpetra::Access::ReadWrite);
  const Settle settle{flow.laws(), {}};
  Kokkos::parallel_for(
      "thixis::models::settle_prediction", Range(0, flow.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        const LocalIndex k = unknowns_per_cell * K;
        const PhaseState U = settle.settled(settle.laws.state(x(k + gas_saturation, 0), x(k + pressure, 0), x(k + dissolved, 0)));
        x(k + gas_saturation, 0) = U.s_g;
        x(k + pressure, 0) = U.P;
        x(k + dissolved, 0) = U.chi;
      });
  return out;
}

}  // namespace thixis::models
