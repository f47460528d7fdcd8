#include "run_unsteady.hpp"

#include <fmt/format.h>

#include <Teuchos_RCP.hpp>
#include <cmath>

#include "checkpoint.hpp"
#include "expectations.hpp"
#include "follow_evolution.hpp"
#include "interrupt.hpp"
#include "step_control.hpp"
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

std::optional<double> effectivity(const models::Evolution& evolution) {
  const auto error = evolution.energy_error();
  const auto bound = evolution.estimate_so_far();
  if (!error || !bound) return {};
  return bound->total / *error;
}

Found found(const RunParams& params, const models::Model& model, const models::Evolution& evolution, const EvolutionOutcome& outcome) {
  Found found;
  found.solved = !outcome.not_wanted;
  if (found.solved) {
    found.energy_error = evolution.energy_error();
    if (outcome.kkt) found.kkt = outcome.kkt->worst();
    if (const auto bound = evolution.estimate_so_far()) {
      found.bound = bound->total;
      found.promise = bound->promise;
    }
    found.effectivity = effectivity(evolution);
    found.newton_iterations = outcome.at.newton_iterations;
    found.newton_finest = outcome.last.steps;
    found.linear_iterations = outcome.at.linear_iterations;
    found.steps = outcome.at.step;
    found.retries = outcome.at.retries;
    found.of_model = evolution.expectations(params.expect, *outcome.X);
    found.contact = evolution.contact(*outcome.X);
    if (!params.expect.at.empty())
      found.at = values_by_name(params.expect, model.point_fields(), evolution.values_at(wanted(params).expected, *outcome.X));
  }
  found.unknowns = evolution.sizes().unknowns_all;
  found.cells = evolution.cells();
  return found;
}

/// Where most of a bound comes from the lengths of the steps, it says nothing of the mesh. No number: `time` is a sum of roots, the bound
/// the root of a sum, and the part may be larger than the whole.
std::string time_decides(const complementarity::Estimate& bound) {
  if (!(bound.time.value_or(0) > 0.7 * bound.total)) return "";
  return ", most of it for the lengths of the steps: shorter ones (time/step) make it smaller, a finer mesh does not";
}

/// Without the shares of all steps there is no bound over all time.
constexpr const char* not_bounded =
    "steps before the checkpoint ran without stopping/estimate = true, so that their share in the error is unknown";

/// What is known of the error and of the solution, in clauses.
std::string qualities(const RunParams& params, const models::Evolution& evolution, const EvolutionOutcome& outcome) {
  std::string clauses;
  const auto error = evolution.energy_error();
  if (error) clauses += fmt::format("; energy error {:.4e}", *error);
  if (params.estimated() && !evolution.every_step_estimated()) clauses += fmt::format("; no bound on the error: {}", not_bounded);
  if (const auto bound = evolution.estimate_so_far()) {
    const double norm = std::sqrt(outcome.at.time) * evolution.energy_norm(*outcome.X);
    clauses += "; " + bound_clause(evolution.bound_name(), *bound) + contradiction(*bound, error, norm) + time_decides(*bound);
  }
  for (const models::Balance& balance : evolution.balances())
    clauses += fmt::format("; {} balanced to {:.1e} in every step", balance.name, balance.worst_step);
  if (outcome.kkt) {
    const bool judged = params.stopping.rule != complementarity::StoppingRule::adaptive;
    const char* unjudged = judged || outcome.kkt->holds(outcome.kkt_tolerance) ? "" : ", which the rule adaptive does not judge";
    clauses += fmt::format("; contact conditions hold to {:.1e}{}", outcome.kkt->worst(), unjudged);
  }
  return clauses;
}

std::string effort(const TimePosition& at) {
  return fmt::format("{} time step{}, {} Newton step{} and {} Krylov iteration{}", at.step, at.step == 1 ? "" : "s", at.newton_iterations,
                     at.newton_iterations == 1 ? "" : "s", at.linear_iterations, at.linear_iterations == 1 ? "" : "s") +
         (at.retries > 0 ? fmt::format(" ({} attempt{} given up)", at.retries, at.retries == 1 ? "" : "s") : "");
}

Verdict judge(const RunParams& params, const models::Model& model, const models::Evolution& evolution, const core::Deck& deck,
              const EvolutionOutcome& outcome) {
  const std::string clauses = fmt::format("{}", fmt::join(missed(params.expect, found(params, model, evolution, outcome)), "; "));
  if (outcome.not_wanted) {
    if (!clauses.empty()) return {ExitCode::target_missed, "not solved (max iterations = 0), and not as expected: " + clauses + "."};
    return {ExitCode::done, "not solved: max iterations = 0 only counts the unknowns."};
  }
  if (!outcome.stopped.empty())
    return {ExitCode::interrupted,
            fmt::format("{} at time {:.6g} of {:.6g}, after {}.", outcome.stopped, outcome.at.time, params.time->end, effort(outcome.at))};
  if (!outcome.mistake.empty())
    return {ExitCode::input, fmt::format("solved up to time {:.6g} of {:.6g}, in {}; then: {}", outcome.at.time, params.time->end,
                                         effort(outcome.at), deck.located(core::InputError(outcome.mistake)).what())};
  if (!outcome.solved) return {ExitCode::not_converged, "not converged: " + outcome.why};
  if (params.stopping.rule != complementarity::StoppingRule::adaptive && outcome.kkt && !outcome.kkt->holds(outcome.kkt_tolerance))
    return {ExitCode::not_converged, not_in_contact(outcome.last, *outcome.kkt, outcome.kkt_tolerance)};
  const auto bound = evolution.estimate_so_far();
  if (params.stopping.target && bound && bound->total > *params.stopping.target)
    return {
        ExitCode::target_missed,
        fmt::format(
            "target missed: {}, not {:g}{}{}{}.", bound_clause(evolution.bound_name(), *bound), *params.stopping.target,
            outcome.refinement_limited
                ? "; adapt/max levels or adapt/max unknowns kept the mesh from becoming finer: allow more, or take a higher method/degree"
                : "",
            outcome.steps_too_long ? "; most of it is for the lengths of the steps: take shorter ones (time/step)" : "",
            clauses.empty() ? "" : "; besides, not as expected: " + clauses)};
  if (params.stopping.target && !bound)
    return {ExitCode::target_missed, fmt::format("stopping/target = {:g} can not be judged: {}.", *params.stopping.target, not_bounded)};
  if (!clauses.empty()) return {ExitCode::target_missed, "solved, but not as expected: " + clauses + "."};
  return {ExitCode::done, fmt::format("solved in {}{}.", effort(outcome.at), qualities(params, evolution, outcome))};
}

output::Summary summarize(const RunParams& params, const models::Model& model, const models::Evolution& evolution,
                          const EvolutionOutcome& outcome, const Verdict& verdict, double seconds, const Versions& versions) {
  output::Summary summary = begin_summary(params, model, verdict, evolution.comm(), seconds, versions);
  const auto sizes = evolution.sizes();
  summary.cells = evolution.cells();
  summary.unknowns.all = sizes.unknowns_all;
  summary.unknowns.global = sizes.unknowns_global;
  summary.nonzeros = sizes.nonzeros;
  if (outcome.not_wanted) return summary;
  summary.newton_iterations = outcome.at.newton_iterations;
  summary.newton_finest = outcome.last.steps;
  summary.linear_iterations = outcome.at.linear_iterations;
  summary.energy_error = evolution.energy_error();
  if (const auto bound = evolution.estimate_so_far()) summary.estimate = parts(*bound, evolution.doubts());
  summary.effectivity = effectivity(evolution);
  summary.active_points = outcome.active.count();
  if (outcome.kkt) {
    const auto& kkt = *outcome.kkt;
    summary.kkt = {kkt.infeasible, kkt.negative, kkt.complementary, kkt.between_nodes, kkt.equilibrium};
  }
  summary.in_time = output::SummaryTime{outcome.at.step, outcome.at.retries, outcome.at.time};
  summary.of_model = evolution.summary(*outcome.X);
  return summary;
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
  const EvolutionCheckpoint checkpoint(directory.checkpoint(), params, deck);
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
  const Verdict verdict = judge(params, model, *evolution, deck, outcome);
  summarize(params, model, *evolution, outcome, verdict, clock.seconds(), versions).write(directory.summary(), comm);
  if (!outcome.not_wanted) say_doubts(evolution->estimate_so_far(), evolution->doubts());
  return conclude(directory, verdict, invite, comm, clock.seconds());
}

}  // namespace thixis::drive
