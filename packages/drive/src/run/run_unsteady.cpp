#include "run/run_unsteady.hpp"

#include <fmt/format.h>

#include <Teuchos_RCP.hpp>

#include "follow/follow_evolution.hpp"
#include "follow/interrupt.hpp"
#include "judge/expectations.hpp"
#include "judge/verdict_in_time.hpp"
#include "restart/checkpoint.hpp"
#include "steps/step_control.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/text.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/drive/run.hpp"

namespace thixis::drive {
namespace {

using core::ExitCode;
namespace log = core::log;

void say_where(const TimePosition& from) {
  log::info("goes on from time {:.6g}, behind step {} ({} Newton steps so far)", from.time, from.step, from.newton_iterations);
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

}  // namespace

core::ExitCode run_unsteady(const RunParams& params, const models::UnsteadyModel& model, const core::Deck& deck, const core::Comm& comm,
                            const Versions& versions, const output::StoredCheckpoint* stored) {
  const core::Stopwatch clock;
  // what is wrong in the scene on this mesh shows here, before anything is written
  std::unique_ptr<models::Evolution> evolution;
  {
    const core::Region region("mesh");
    evolution = model.evolve(params.mesh, comm, deck.folder(), wanted(params));
  }
  output::RunDirectory directory(params.output.directory);
  const CheckpointFile checkpoint(directory.checkpoint(), params, deck);
  const bool goes_on = stored && same_directory(*stored, params, directory.path());
  const StoredEvolution from = stored ? stored_evolution(*stored) : StoredEvolution{};
  if (stored) check_restart(*stored, from, params, goes_on, *evolution);
  evolution->check(known_times(*params.time, evolution->jumps(), from.at.time));
  open(directory, params, deck, goes_on, comm);
  introduce(deck, model, comm, versions);
  if (stored) {
    say_where(from.at);
    say_differences(*stored, params);
  }
  log::info("{} cells, {} unknowns ({} in the linear system)", evolution->cells(), evolution->sizes().unknowns_all,
            evolution->sizes().unknowns_global);
  if (!goes_on) remove_file(checkpoint.path(), comm);

  EvolutionOutcome outcome;
  std::string invite;
  if (params.newton.max_iterations == 0) {
    outcome = evolve(*evolution, params, {});
  } else {
    const Interrupt listens;
    Written before = goes_on ? from.written : Written{};
    before.seconds = from.written.seconds;
    FollowEvolution follow(directory, params, *evolution, checkpoint, before, from.at.time);
    outcome = evolve(*evolution, params, follow.observer(), stored);
    const bool failed = outcome.stopped.empty() && !outcome.solved;
    if (failed || (outcome.solved && params.output.checkpoint_every > 0))
      follow.save(outcome.at, outcome.next_length, *evolution, *outcome.X);
    if (!outcome.solved) invite = invitation(checkpoint.path(), outcome);
    follow.finish(*evolution, outcome);
  }
  const Found seen = found(params, model, *evolution, outcome);
  const Verdict verdict = judge(ending(params, *evolution, deck, outcome), missed(params.expect, seen));
  summarize(params, model, seen, verdict, comm, clock.seconds(), versions).write(directory.summary(), comm);
  if (!outcome.not_wanted) say_doubts(seen.estimate, seen.doubts);
  return conclude(directory, verdict, invite, comm, clock.seconds());
}

}  // namespace thixis::drive
