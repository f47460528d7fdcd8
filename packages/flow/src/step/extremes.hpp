#pragma once
#include "step/operator.hpp"

namespace thixis::flow {

/// max |x_u| of an unknown over the cells of all ranks. Collective.
double largest(const algebra::Vector& X, Unknown u);

/// The right end of the cells with s_g > trace, or the left end of the domain if there is none. Collective.
double right_end_of_gas(const TwoPhaseOperator& flow, const algebra::Vector& X, double trace);

/// Of all cells. Collective.
double volume(const fv::Grid& grid);

/// The squared diagonal of the box around the domain. Collective.
double squared_diagonal(const fv::Grid& grid);

}  // namespace thixis::flow
