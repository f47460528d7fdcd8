#pragma once
/// What stationary runs and runs in time write and say in the same way.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "judge/expectations.hpp"
#include "judge/verdict.hpp"
#include "thixis/core/comm.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/models/model.hpp"
#include "thixis/output/directory.hpp"
#include "thixis/output/fields.hpp"
#include "thixis/output/history.hpp"
#include "thixis/output/summary.hpp"

namespace thixis::drive {

using Versions = std::vector<std::pair<std::string, std::string>>;

/// Makes the output directory, writes the deck as run, which can be run again from there, and begins the log. `goes_on`: behind the files
/// of the interrupted run.
void open(output::RunDirectory& directory, const RunParams& params, const core::Deck& deck, bool goes_on, const core::Comm& comm);
/// Says what is run.
void introduce(const core::Deck& deck, const models::Model& model, const core::Comm& comm, const Versions& versions);

/// The columns of the log's tables: eta_disc, eta_lin, eta_alg, eta; spaces where there is no estimate.
std::string estimate_header();
std::string estimate_columns(const std::optional<complementarity::Estimate>& eta);
void set_estimate(output::HistoryRow& row, const std::optional<complementarity::Estimate>& eta);

/// The cell fields of the estimate that the deck asks for.
void add_estimates(const OutputParams& params, const models::CellEstimates& cells, const output::Grid& grid,
                   std::vector<output::FieldData>& fields);

/// `doubts`: what keeps it from being guaranteed.
output::SummaryEstimate parts(const complementarity::Estimate& eta, const std::vector<std::string>& doubts = {});
/// Says them.
void say_doubts(const std::optional<complementarity::Estimate>& eta, const std::vector<std::string>& doubts);
/// The summary of a run, at rest or in time.
output::Summary summarize(const RunParams& params, const models::Model& model, const Found& found, const Verdict& verdict,
                          const core::Comm& comm, double seconds, const Versions& versions);

/// Table of times, folder, verdict: the end of the log.
core::ExitCode conclude(const output::RunDirectory& directory, const Verdict& verdict, const std::string& invitation,
                        const core::Comm& comm, double seconds);

}  // namespace thixis::drive
