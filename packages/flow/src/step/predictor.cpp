#include "step/predictor.hpp"

#include "laws/settle.hpp"
#include "step/vectors.hpp"

namespace thixis::flow {

Teuchos::RCP<algebra::Vector> predicted(const TwoPhaseOperator& flow, const algebra::Vector& X, const algebra::Vector& X_before,
                                        double ratio) {
  const auto out = Teuchos::rcp(new algebra::Vector(X, Teuchos::Copy));
  out->update(-ratio, X_before, 1 + ratio);
  const auto x = write(*out);
  const Settle settle{flow.laws(), {}};
  Kokkos::parallel_for(
      "thixis::flow::settle_prediction", Cells(0, flow.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        const LocalIndex k = unknowns_per_cell * K;
        const PhaseState U = settle.settled(settle.laws.state(x(k + gas_saturation, 0), x(k + pressure, 0), x(k + dissolved, 0)));
        x(k + gas_saturation, 0) = U.s_g;
        x(k + pressure, 0) = U.P;
        x(k + dissolved, 0) = U.chi;
      });
  return out;
}

Teuchos::RCP<algebra::Vector> in_equilibrium(const TwoPhaseOperator& flow, const algebra::Vector& X) {
  const auto out = Teuchos::rcp(new algebra::Vector(X, Teuchos::Copy));
  const auto x = write(*out);
  const TwoPhaseLaws laws = flow.laws();
  Kokkos::parallel_for(
      "thixis::flow::in_equilibrium", Cells(0, flow.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        const LocalIndex k = unknowns_per_cell * K;
        const PhaseState U = laws.state(x(k + gas_saturation, 0), x(k + pressure, 0), x(k + dissolved, 0));
        if (!(U.s_g > 0)) return;
        const double S = 1 - U.s_g, content = laws.beta_l * U.chi * S + laws.beta_g * U.P_g.value * U.s_g;
        const double P_g = content / (laws.H * S + laws.beta_g * U.s_g);
        x(k + pressure, 0) += P_g - U.P_g.value;
        x(k + dissolved, 0) = laws.H * P_g / laws.beta_l;
      });
  return out;
}

}  // namespace thixis::flow
