#pragma once
#include "level/membrane_level.hpp"
#include "thixis/complementarity/kkt.hpp"

namespace thixis::membranes {

/// A solution X with its membranes as functions.
struct MembraneSolution {
  const MembraneLevel& on_mesh;  ///< with the data of its time
  Fields x;
  method::Coefficients u[2] = {};
  method::Coefficients rate[2] = {};  ///< of a scene in time: (u_alpha - u_alpha^{n-1}) / tau, which the equations hold besides
};

/// What the verifier judges, from forces cell by cell (docs/methods/membranes.md, 6). Collective.
complementarity::KktData kkt_data(const MembraneSolution& solution);

}  // namespace thixis::membranes
