#include "thixis/drive/run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "checkpoint.hpp"
#include "follow.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/log.hpp"
#include "thixis/core/memory.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/output/directory.hpp"
#include "thixis/output/fields.hpp"
#include "thixis/output/summary.hpp"
#include "verdict.hpp"

namespace thixis::drive {
namespace {

using core::ExitCode;
namespace log = core::log;

/// Makes the output directory and begins its log. `goes_on`: behind the files of the interrupted run.
void open(const output::RunDirectory& directory, const RunParams& params, bool goes_on, const core::Comm& comm) {
  directory.create(comm);
  directory.write_deck(core::to_xml(RunParams::schema(), params), comm);
  comm.on_root([&] { log::open(directory.log(), goes_on ? log::Old::keep : log::Old::overwrite); });
}

/// Says what is run, and where a restart goes on from.
void introduce(const core::Deck& deck, const models::Model& model, const core::Comm& comm,
               const std::vector<std::pair<std::string, std::string>>& versions, const output::StoredCheckpoint* stored) {
  log::info("{}: model {}{}, on {} {}", deck.file(), model.name(), model.case_name().empty() ? "" : ", case " + model.case_name(),
            comm.size(), comm.size() == 1 ? "rank" : "ranks");
  std::string text;
  for (const auto& [name, version] : versions) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, version);
  log::info("{}", text);
  if (!stored) return;
  const Position from = position_of(*stored);
  log::info("goes on from level {}, Newton step {} ({} steps on all levels)", from.level, from.newton_on_level, from.newton_iterations);
}

/// How to go on, as a command: with more steps where those were too few.
void invite(const std::string& checkpoint, const RunParams& params, const Outcome& outcome) {
  const int most = params.newton.max_iterations;
  const bool too_few = !outcome.solved && outcome.finest.steps >= most;
  log::info("the last iterate is kept; to go on from it: thixis restart {}{}", checkpoint,
            too_few ? fmt::format(" --set \"newton/max iterations={}\"", std::max(50, 2 * most)) : "");
}

output::SummaryEstimate parts(const complementarity::Estimate& eta) {
  return {eta.total, eta.discretization, eta.linearization, eta.algebraic, {}};
}

output::Summary summarize(const RunParams& params, const models::Model& model, const Outcome& outcome, const Verdict& verdict,
                          const core::Comm& comm, double total, const std::vector<std::pair<std::string, std::string>>& versions) {
  output::Summary summary;
  const auto sizes = outcome.discretization->sizes();
  summary.verdict = verdict.sentence;
  summary.exit_code = static_cast<int>(verdict.code);
  summary.model = model.name();
  summary.problem_case = model.case_name();
  summary.method = method::to_text(params.method.name);
  summary.degree = params.method.degree;
  summary.ranks = comm.size();
  summary.threads = Kokkos::DefaultExecutionSpace::concurrency();
  summary.cells = outcome.mesh->global_cells;
  summary.unknowns.all = sizes.unknowns_all;
  summary.unknowns.global = sizes.unknowns_global;
  summary.nonzeros = sizes.nonzeros;
  summary.newton_iterations = outcome.at.newton_iterations;
  summary.newton_finest = outcome.at.newton_on_level;
  summary.linear_iterations = outcome.at.linear_iterations;
  summary.energy_error = outcome.energy_error;
  if (outcome.estimate) summary.estimate = parts(*outcome.estimate);
  summary.effectivity = outcome.effectivity();
  if (outcome.published) {
    summary.estimate_published = parts(outcome.published->parts);
    summary.estimate_published->terms = outcome.published->terms;
    if (outcome.energy_error) summary.effectivity_published = outcome.published->parts.total / *outcome.energy_error;
  }
  summary.active_points = outcome.finest.active;
  if (outcome.kkt) {
    const auto& kkt = *outcome.kkt;
    summary.kkt = {kkt.infeasible, kkt.negative, kkt.complementary, kkt.between_nodes, kkt.equilibrium};
    summary.energy_norm = outcome.energy_norm;
  }
  const auto longest = [&](const char* region) { return comm.max(core::seconds(region)); };
  summary.time = {comm.max(total),   longest("mesh"),     longest("assembly"), longest("preconditioner"),
                  longest("linear"), longest("estimate"), longest("output")};
  summary.memory_mb = comm.sum(core::peak_memory_mb());
  summary.versions = versions;
  return summary;
}

/// A value for each owned cell of the mesh, on the cells of the grid that show it: as many of them for each one.
output::FieldData on_cells(const std::string& name, const std::vector<double>& values, std::size_t shown) {
  output::FieldData field{name, output::Centre::cell, {}};
  const std::size_t pieces = values.empty() ? 0 : shown / values.size();
  for (const double value : values) field.values.insert(field.values.end(), pieces, value);
  return field;
}

void write_fields(const output::RunDirectory& directory, const OutputParams& params, const Outcome& outcome, const core::Comm& comm) {
  const core::Region region("output");
  const output::Grid grid = outcome.discretization->grid();
  std::vector<output::FieldData> fields;
  if (const auto names = params.model_names(); params.fields == "all" || !names.empty())
    fields = outcome.discretization->fields(*outcome.X, outcome.finest.active_set, names);
  if (outcome.estimate) {
    const models::CellEstimates& cells = outcome.cell_estimates;
    for (const auto& name : params.estimate_names())
      fields.push_back(on_cells(name,
                                name == "eta_disc"  ? cells.discretization
                                : name == "eta_lin" ? cells.linearization
                                                    : cells.algebraic,
                                grid.cells()));
  }
  output::FieldWriter writer(directory.path(), comm);
  writer.write(grid, fields, 0);
  writer.close();
}

}  // namespace

ExitCode run(const RunParams& params, const models::Model& any_model, const core::Deck& deck, const core::Comm& comm,
             const std::vector<std::pair<std::string, std::string>>& versions, const output::StoredCheckpoint* stored) {
  const core::Stopwatch clock;
  core::reset_regions();
  const auto& model = dynamic_cast<const models::StationaryModel&>(any_model);
  mesh::Hierarchy hierarchy;
  {
    const core::Region region("mesh");
    hierarchy = mesh::build(params.mesh, comm, deck.folder());
  }
  // what is wrong in the scene on this mesh shows here, before anything is written
  const bool nested = params.newton.start == complementarity::Start::nested;
  for (const auto& mesh : hierarchy.levels)
    if (nested || &mesh == &hierarchy.finest()) model.check(mesh, params.output.model_names());

  const output::RunDirectory directory(params.output.directory);
  CheckpointFile checkpoint(directory.checkpoint(), params, deck, hierarchy);
  if (stored) {
    replay(*stored, hierarchy, checkpoint);
    check_restart(*stored, params, hierarchy);
  }
  const bool goes_on = stored && same_directory(*stored, directory.path());
  open(directory, params, goes_on, comm);
  introduce(deck, model, comm, versions, stored);
  if (!goes_on) checkpoint.remove(comm);

  output::History history =
      output::History::go_on(directory.history(), goes_on ? history_rows_of(*stored) : 0, comm, params.output.history);
  Follow follow(history, checkpoint, params, stored ? seconds_of(*stored) : 0);
  const Outcome outcome = solve_stationary(model, hierarchy, params, follow.observer(), stored);
  const Verdict verdict = judge(params, outcome);
  const bool to_be_kept = verdict.code == ExitCode::not_converged || (params.output.checkpoint_every > 0 && !outcome.not_wanted);
  const bool kept = to_be_kept && follow.save(outcome.at, *outcome.discretization, *outcome.X);

  if (!outcome.not_wanted && !params.output.no_fields()) write_fields(directory, params.output, outcome, comm);
  const auto summary = summarize(params, model, outcome, verdict, comm, clock.seconds(), versions);
  summary.write(directory.summary(), comm);
  log::info("{}", core::region_table(comm, clock.seconds()));
  log::info("results in {}", directory.path());
  if (kept && verdict.code == ExitCode::not_converged) invite(checkpoint.path(), params, outcome);
  log::verdict("{}", verdict.sentence);
  log::close();
  return verdict.code;
}

}  // namespace thixis::drive
