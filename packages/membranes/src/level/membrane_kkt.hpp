#pragma once
#include "problem/membrane_problem.hpp"
#include "thixis/complementarity/kkt.hpp"

namespace thixis::membranes {

/// A solution X with its membranes as functions.
struct MembraneSolution {
  const MembraneScene& scene;
  const method::Space& space;
  const std::array<method::FormPtr, 2>& form;
  const MembraneProblem& problem;
  const Teuchos::RCP<algebra::Vector>* body;  ///< loads, before Dirichlet data are moved to the right
  Fields x;
  method::Coefficients u[2] = {};
  double t = 0;                       ///< of the data
  method::Coefficients rate[2] = {};  ///< of a scene in time: (u_alpha - u_alpha^{n-1}) / tau, which the equations hold besides
};

/// What the verifier judges, from forces cell by cell (docs/methods/membranes.md, 6). Collective.
complementarity::KktData kkt_data(const MembraneSolution& solution);

}  // namespace thixis::membranes
