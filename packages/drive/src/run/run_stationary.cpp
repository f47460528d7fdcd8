#include "run/run_stationary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "checks/sizes.hpp"
#include "follow/follow.hpp"
#include "judge/verdict_at_rest.hpp"
#include "run/frame.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/drive/run.hpp"
#include "thixis/output/probes.hpp"

namespace thixis::drive {
namespace {

using core::ExitCode;

/// Where a restart goes on from.
std::string place_of(const Position& from) {
  return fmt::format("level {}, Newton step {} ({} steps on all levels)", from.level, from.newton_on_level, from.newton_iterations);
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

/// The meshes of the deck. What is wrong in the scene on one of them shows here, before anything is written.
mesh::Hierarchy checked_meshes(const RunParams& params, const models::StationaryModel& model, const models::Wanted& asked,
                               const core::Deck& deck, const core::Comm& comm) {
  mesh::Hierarchy hierarchy;
  {
    const core::Region region("mesh");
    hierarchy = mesh::build(params.mesh, comm, deck.folder());
  }
  require_memory(params, static_cast<double>(hierarchy.finest().global_cells), comm);
  const bool nested = params.newton.start == complementarity::Start::nested;
  for (const auto& mesh : hierarchy.levels) {
    if (&mesh == &hierarchy.finest()) model.check(mesh, asked);
    else if (nested) model.check(mesh, {asked.fields, {}, {}});
  }
  return hierarchy;
}

}  // namespace

core::ExitCode run_stationary(const RunParams& params, const models::StationaryModel& model, const core::Deck& deck, const core::Comm& comm,
                              const Versions& versions, const output::StoredCheckpoint* stored) {
  Frame frame(params, model, deck, comm, versions, stored);
  const models::Wanted asked = wanted(params);
  mesh::Hierarchy hierarchy = checked_meshes(params, model, asked, deck, comm);
  if (stored) {
    replay(*stored, hierarchy, frame.checkpoint());
    check_restart(*stored, params, hierarchy);
  }
  const StoredIterate from = stored ? stored_iterate(*stored) : StoredIterate{};
  frame.begin(place_of(from.at));

  Follow follow(frame.directory(), params, comm, frame.checkpoint(), frame.before(from.written));
  const Outcome outcome = solve_stationary(model, hierarchy, params, follow.observer(), stored);
  const Found seen = found(outcome);
  const Verdict verdict = judge(ending(params, outcome), missed(params.expect, seen));
  const bool failed = verdict.code == ExitCode::not_converged;
  const bool to_be_kept = failed || (params.output.checkpoint_every > 0 && !outcome.not_wanted);
  const bool kept = to_be_kept && follow.save(outcome.at, *outcome.discretization, *outcome.X);

  if (!outcome.not_wanted && !params.output.no_fields()) write_fields(frame.directory(), params.output, outcome, comm);
  if (!outcome.not_wanted && !asked.probes.empty()) write_probes(frame.directory(), model, asked.probes, outcome, comm);
  return frame.end(seen, verdict, kept && failed ? invitation(frame.checkpoint().path(), params, outcome) : "");
}

}  // namespace thixis::drive
