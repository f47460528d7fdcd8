#pragma once
#include "thixis/drive/evolve.hpp"

namespace thixis::drive {

/// Refines the mesh of a run in time where the share of a step in the error is too large for the target: |eta_disc|² > target² length/end.
///
/// As far as `adapt` allows (else it says so in `outcome`), and unless most of it is the error in time, which only shorter steps take away.
/// X in `outcome` is then on the finer mesh. Whether the mesh was refined. Collective.
bool refined(models::Evolution& evolution, const RunParams& params, const models::TimeStep& step, const complementarity::Estimate& eta,
             EvolutionOutcome& outcome, const EvolutionObserver& observer);

}  // namespace thixis::drive
