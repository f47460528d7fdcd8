#pragma once
#include <string>

#include "thixis/core/comm.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/core/error.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/models/model.hpp"

namespace thixis::drive {

/// Refuses what the schema knows but no code serves yet, and combinations that can not work. Throws InputError.
void check_served(const RunParams& params);

/// Runs a deck from its mesh to its files: mesh, solve, verify, `expect`, output, verdict. Nothing is written before mesh and scene are
/// known to be valid. Returns the exit code; the same on all ranks.
core::ExitCode run(const RunParams& params, const models::Model& model, const core::Deck& deck, const core::Comm& comm,
                   const std::vector<std::pair<std::string, std::string>>& versions);

}  // namespace thixis::drive
