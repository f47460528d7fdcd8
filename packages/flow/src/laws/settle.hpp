#pragma once
#include "laws/laws.hpp"
#include "thixis/fv/grid.hpp"

namespace thixis::flow {

/// The state with the pressure of the liquid and the mass of hydrogen of another one that obeys s_g >= 0, G >= 0, s_g G = 0
/// (docs/methods/two_phase_estimates.md, 2.1).
struct Settle {
  TwoPhaseLaws laws;
  fv::View<PhaseState*> states;  ///< in and out

  KOKKOS_FUNCTION PhaseState settled(const PhaseState& U) const {
    const double content = laws.beta_l * U.chi * (1 - U.s_g) + laws.beta_g * U.P_g.value * U.s_g;
    if (content <= laws.H * (U.P + laws.capillary(0).value)) return laws.state(0, U.P, content / laws.beta_l);
    const double limit = laws.S_gr + TwoPhaseLaws::dry * laws.width;
    double s = U.s_g < 0 ? 0 : U.s_g > limit ? limit : U.s_g;
    for (int k = 0; k < 60; ++k) {  // Newton: P_g (H (1 - s) + beta_g s) rises with s
      const Law P_c = laws.capillary(s);
      const double P_g = U.P + P_c.value, share = laws.H * (1 - s) + laws.beta_g * s;
      const double step = (content - P_g * share) / (P_c.slope * share + P_g * (laws.beta_g - laws.H));
      const double next = s + step < 0 ? 0 : s + step > limit ? limit : s + step;
      const bool done = !(Kokkos::Experimental::fabs(next - s) > 1e-15);
      s = next;
      if (done) break;
    }
    const double P_g = U.P + laws.capillary(s).value;
    return laws.state(s, U.P, laws.H * P_g / laws.beta_l);
  }
  KOKKOS_FUNCTION void operator()(LocalIndex K) const { states(K) = settled(states(K)); }
};

}  // namespace thixis::flow
