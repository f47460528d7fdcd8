#pragma once
#include "problem/pattern.hpp"
#include "problem/scales.hpp"

namespace thixis::flow {

/// Where the equations of a step were linearized; X null: nowhere yet.
struct Linearization {
  Teuchos::RCP<const algebra::Vector> X;
  fv::View<PhaseState*> states;  ///< of all local cells
  fv::View<FaceFlux*> fluxes;    ///< of all local faces
};

/// The derivatives there of the equations of a step of this length, divided by scales.mass, and of a K + b G by the unknowns divided by
/// scales.unknown, into the matrix of the pattern.
void fill_jacobian(const Linearization& at, double length, const fv::Grid& grid, const TwoPhaseLaws& laws, const FlowScales& scales,
                   const algebra::Vector& a, const algebra::Vector& b, const Pattern& pattern);

}  // namespace thixis::flow
