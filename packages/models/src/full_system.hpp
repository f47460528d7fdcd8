#pragma once
#include "linearized_system.hpp"
#include "membrane_measure.hpp"

namespace thixis::models {

/// The system of all fields (u_1, …, u_m, lambda), interlaced with lambda last in the node: that order lets incomplete factorizations pass
/// the zero diagonal of the contact rows. The rows have the weights of the measure, so that the solver sees the norm that it is judged by.
std::unique_ptr<LinearizedSystem> make_full_system(const MembraneOperator& membranes, const MembraneMeasure& measure,
                                                   const algebra::LinearParams& params, const algebra::MapPtr& map,
                                                   const Teuchos::RCP<const algebra::MultiVector>& coordinates);

}  // namespace thixis::models
