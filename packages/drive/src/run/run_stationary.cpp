#include "run/run_stationary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "checks/sizes.hpp"
#include "follow/follow.hpp"
#include "restart/checkpoint.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/log.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/drive/run.hpp"
#include "thixis/output/probes.hpp"

namespace thixis::drive {
namespace {

using core::ExitCode;
namespace log = core::log;

/// Where a restart goes on from.
void say_where(const output::StoredCheckpoint& stored) {
  const Position from = position_of(stored);
  log::info("goes on from level {}, Newton step {} ({} steps on all levels)", from.level, from.newton_on_level, from.newton_iterations);
}

/// How to go on, as a command: with more steps where those were too few.
std::string invitation(const std::string& checkpoint, const RunParams& params, const Outcome& outcome) {
  const int most = params.newton.max_iterations;
  const bool too_few = !outcome.solved && outcome.finest.steps >= most && most <= std::numeric_limits<int>::max() / 2;
  return fmt::format("the last iterate is kept; to go on from it: thixis restart {}{}", checkpoint,
                     too_few ? fmt::format(" --set \"newton/max iterations={}\"", std::max(50LL, 2LL * most)) : "");
}

void write_fields(const output::RunDirectory& directory, const OutputParams& params, const Outcome& outcome, const core::Comm& comm) {
  const core::Region region("output");
  const output::Grid grid = outcome.discretization->grid();
  std::vector<output::FieldData> fields;
  if (const auto names = params.model_names(); params.fields == "all" || !names.empty())
    fields = outcome.discretization->fields(*outcome.X, outcome.finest.active_set, names);
  if (outcome.estimate) add_estimates(params, outcome.cell_estimates, grid, fields);
  output::FieldWriter writer(directory.path(), comm);
  writer.write(grid, fields, 0);
  writer.close();
}

void write_probes(const output::RunDirectory& directory, const models::Model& model, const std::vector<models::Probe>& probes,
                  const Outcome& outcome, const core::Comm& comm) {
  const core::Region region("output");
  std::vector<std::array<double, 2>> points;
  for (const auto& probe : probes) points.push_back(probe.at);
  output::write_probes(directory.probes(), points, model.point_fields(), outcome.discretization->values_at(probes, *outcome.X), comm);
}

}  // namespace

core::ExitCode run_stationary(const RunParams& params, const models::StationaryModel& model, const core::Deck& deck, const core::Comm& comm,
                              const Versions& versions, const output::StoredCheckpoint* stored) {
  const core::Stopwatch clock;
  mesh::Hierarchy hierarchy;
  {
    const core::Region region("mesh");
    hierarchy = mesh::build(params.mesh, comm, deck.folder());
  }
  require_memory(params, static_cast<double>(hierarchy.finest().global_cells), comm);
  // what is wrong in the scene on this mesh shows here, before anything is written
  const bool nested = params.newton.start == complementarity::Start::nested;
  const models::Wanted asked = wanted(params);
  for (const auto& mesh : hierarchy.levels) {
    if (&mesh == &hierarchy.finest()) model.check(mesh, asked);
    else if (nested) model.check(mesh, {asked.fields, {}, {}});
  }

  output::RunDirectory directory(params.output.directory);
  CheckpointFile checkpoint(directory.checkpoint(), params, deck);
  if (stored) {
    replay(*stored, hierarchy, checkpoint);
    check_restart(*stored, params, hierarchy);
  }
  const bool goes_on = stored && same_directory(*stored, params, directory.path());
  open(directory, params, deck, goes_on, comm);
  introduce(deck, model, comm, versions);
  if (stored) {
    say_where(*stored);
    say_differences(*stored, params);
  }
  if (!goes_on) remove_file(checkpoint.path(), comm);

  output::History history =
      output::History::go_on(directory.history(), goes_on ? history_rows_of(*stored) : 0, comm, params.output.history);
  Follow follow(history, checkpoint, params, stored ? seconds_of(*stored) : 0);
  const Outcome outcome = solve_stationary(model, hierarchy, params, follow.observer(), stored);
  const Verdict verdict = judge(params, outcome);
  const bool to_be_kept = verdict.code == ExitCode::not_converged || (params.output.checkpoint_every > 0 && !outcome.not_wanted);
  const bool kept = to_be_kept && follow.save(outcome.at, *outcome.discretization, *outcome.X);

  if (!outcome.not_wanted && !params.output.no_fields()) write_fields(directory, params.output, outcome, comm);
  if (!outcome.not_wanted && !asked.probes.empty()) write_probes(directory, model, asked.probes, outcome, comm);
  const Found seen = found(outcome);
  summarize(params, model, seen, verdict, comm, clock.seconds(), versions).write(directory.summary(), comm);
  say_doubts(seen.estimate, seen.doubts);
  const bool invite = kept && verdict.code == ExitCode::not_converged;
  return conclude(directory, verdict, invite ? invitation(checkpoint.path(), params, outcome) : "", comm, clock.seconds());
}

}  // namespace thixis::drive
