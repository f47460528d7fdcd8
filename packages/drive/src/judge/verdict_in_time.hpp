#pragma once
#include "judge/verdict.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/drive/evolve.hpp"

namespace thixis::drive {

/// Without the shares of all steps there is no bound over all time.
extern const char* const not_bounded;

/// How a run in time ended.
Ending ending(const RunParams& params, const models::Evolution& evolution, const core::Deck& deck, const EvolutionOutcome& outcome);

}  // namespace thixis::drive
