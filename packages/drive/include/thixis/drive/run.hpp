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

/// What a run would find before its first step and what shows without a mesh: data at later times that leave no solution. Throws
/// InputError.
void check_ahead(const RunParams& params, const models::Model& model);

/// The fields and points that a deck asks for.
models::Wanted wanted(const RunParams& params);
/// Refuses points and fields of `expect/at` and `output/probes` that the model can not have, as far as no mesh is needed to know it. Throws
/// InputError.
void check_wanted(const RunParams& params, const models::Model& model);

/// Runs a deck from its mesh to its files: mesh, solve, verify, `expect`, output, verdict. Nothing is written before mesh and scene are
/// known to be valid. Returns the exit code; the same on all ranks.
///
/// `checkpoint.h5` is written where the run does not converge (exit code 3), and with output/checkpoint every = n after every n Newton
/// steps and at the end. A new run removes the one of an older run in the same directory.
///
/// With a checkpoint (`stored`, not null; `deck` and `params` then are those it holds, with what was overridden) the run goes on from
/// there: see solve_stationary. In the output directory of the interrupted run the history goes on behind the rows that the checkpoint
/// knows, and the log behind its last line. newton_iterations, newton_finest and linear_iterations of the summary and in `expect` are
/// totals that include what was done before the restart; times are those of this run. Throws InputError if the checkpoint does not fit the
/// deck.
core::ExitCode run(const RunParams& params, const models::Model& model, const core::Deck& deck, const core::Comm& comm,
                   const std::vector<std::pair<std::string, std::string>>& versions, const output::StoredCheckpoint* stored = nullptr);

}  // namespace thixis::drive
