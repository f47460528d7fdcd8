#pragma once
#include "laws/laws.hpp"

namespace thixis::flow {

/// Sizes that make the equations and the increments of the unknowns numbers without unit, derived from the data.
struct FlowScales {
  double pressure;                    ///< P_ref [Pa]
  double mass[components];            ///< phi rho_w, phi H P_ref [kg/m^3]
  double unknown[unknowns_per_cell];  ///< of increments: 1, P_ref, H P_ref/beta_l

  FlowScales(const TwoPhaseLaws& laws, double P_ref)
      : pressure(P_ref),
        mass{laws.porosity * laws.rho_w, laws.porosity * laws.H * P_ref},
        unknown{1, P_ref, laws.H * P_ref / laws.beta_l} {}
};

}  // namespace thixis::flow
