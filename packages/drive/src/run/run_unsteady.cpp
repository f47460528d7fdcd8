#include "run/run_unsteady.hpp"

#include <fmt/format.h>

#include <Teuchos_RCP.hpp>

#include "follow/follow_evolution.hpp"
#include "follow/interrupt.hpp"
#include "judge/expectations.hpp"
#include "judge/verdict_in_time.hpp"
#include "run/frame.hpp"
#include "steps/step_control.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/text.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/drive/run.hpp"

namespace thixis::drive {
namespace {

namespace log = core::log;

/// Where a restart goes on from.
std::string place_of(const TimePosition& from) {
  return fmt::format("time {:.6g}, behind step {} ({} Newton steps so far)", from.time, from.step, from.newton_iterations);
}

/// Behind steps without estimate no bound can be had; a rule or a step control that only looks at the steps to come may still use theirs.
void check_unbounded(const RunParams& params) {
  const std::pair<const char*, bool> asked[] = {{"stopping/target", params.stopping.target.has_value()},
                                                {"stopping/estimate", params.stopping.estimate.value_or(false)},
                                                {"expect/bound at most", params.expect.bound_at_most.has_value()},
                                                {"expect/promise", params.expect.promise.has_value()},
                                                {"expect/effectivity between", params.expect.effectivity_between.has_value()}};
  std::vector<std::string> mistakes;
  for (const auto& [path, given] : asked)
    if (given)
      mistakes.push_back(
          fmt::format("{}: a bound on the error holds for all time from 0, but {}; begin a new run (thixis run) with "
                      "stopping/estimate = true, or leave this out.",
                      path, not_bounded));
  if (!mistakes.empty()) throw core::InputError(core::join(mistakes, "\n"));
}

/// Throws InputError where the deck leaves nothing to do, or contradicts what the interrupted run has left.
void check_restart(const output::StoredCheckpoint& stored, const StoredEvolution& from, const RunParams& params, bool goes_on,
                   models::Evolution& evolution) {
  if (from.at.time >= params.time->end)
    throw core::InputError(fmt::format("time/end: the checkpoint '{}' is at time {:g} already; write a later end than {:g}.", stored.path(),
                                       from.at.time, params.time->end));
  if (goes_on &&
      core::Deck::from_text(stored.deck(), stored.path()).parse(params.catalogue->schema()).output.probes != params.output.probes)
    throw core::InputError(
        "output/probes: series.csv goes on with the probes it has; leave them as they were, or write to another folder with --output.");
  evolution.restore(stored);  // throws where scene, mesh or method are others
  if (!evolution.every_step_estimated()) check_unbounded(params);
}

std::string invitation(const std::string& checkpoint, const EvolutionOutcome& outcome) {
  return fmt::format("to go on from the last step{}: thixis restart {}{}", outcome.mistake.empty() ? "" : " with other data", checkpoint,
                     outcome.mistake.empty() ? "" : " --set PATH=VALUE");
}

/// The scene on the mesh of the deck. What is wrong in it there shows here, before anything is written.
std::unique_ptr<models::Evolution> on_mesh(const RunParams& params, const models::UnsteadyModel& model, const core::Deck& deck,
                                           const core::Comm& comm) {
  const core::Region region("mesh");
  return model.evolve(params.mesh, comm, deck.folder(), wanted(params));
}

/// Step by step, with the files that follow; `invite`: how to go on where the end was not reached.
EvolutionOutcome followed(Frame& frame, models::Evolution& evolution, const RunParams& params, const StoredEvolution& from,
                          const output::StoredCheckpoint* stored, std::string& invite) {
  const Interrupt listens;
  FollowEvolution follow(frame.directory(), params, evolution, frame.checkpoint(), frame.before(from.written), from.at.time);
  EvolutionOutcome outcome = evolve(evolution, params, follow.observer(), stored);
  const bool failed = outcome.stopped.empty() && !outcome.solved;
  if (failed || (outcome.solved && params.output.checkpoint_every > 0)) follow.save(outcome.at, outcome.next_length, evolution, *outcome.X);
  if (!outcome.solved) invite = invitation(frame.checkpoint().path(), outcome);
  follow.finish(evolution, outcome);
  return outcome;
}

}  // namespace

core::ExitCode run_unsteady(const RunParams& params, const models::UnsteadyModel& model, const core::Deck& deck, const core::Comm& comm,
                            const Versions& versions, const output::StoredCheckpoint* stored) {
  Frame frame(params, model, deck, comm, versions, stored);
  const auto evolution = on_mesh(params, model, deck, comm);
  const StoredEvolution from = stored ? stored_evolution(*stored) : StoredEvolution{};
  if (stored) check_restart(*stored, from, params, frame.goes_on(), *evolution);
  evolution->check(known_times(*params.time, evolution->jumps(), from.at.time));
  frame.begin(place_of(from.at));
  const models::Sizes sizes = evolution->sizes();
  log::info("{} cells, {} unknowns ({} in the linear system)", evolution->cells(), sizes.unknowns_all, sizes.unknowns_global);

  std::string invite;
  const bool only_counts = params.newton.max_iterations == 0;
  const EvolutionOutcome outcome = only_counts ? evolve(*evolution, params, {}) : followed(frame, *evolution, params, from, stored, invite);
  const Found seen = found(params, model, *evolution, outcome);
  return frame.end(seen, judge(ending(params, *evolution, deck, outcome), missed(params.expect, seen)), invite);
}

}  // namespace thixis::drive
