#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "checkpoint.hpp"
#include "expectations.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/log.hpp"
#include "thixis/core/memory.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/drive/run.hpp"
#include "thixis/drive/stationary.hpp"
#include "thixis/output/directory.hpp"
#include "thixis/output/fields.hpp"
#include "thixis/output/history.hpp"
#include "thixis/output/summary.hpp"

namespace thixis::drive {
namespace {

using core::ExitCode;
namespace log = core::log;

struct Verdict {
  ExitCode code = ExitCode::done;
  std::string sentence;
};

/// Did the run do what was asked, in one sentence.
Verdict judge(const RunParams& params, const Outcome& outcome, long long cells) {
  const auto missing = missed(params.expect, outcome, cells);
  const std::string clauses = fmt::format("{}", fmt::join(missing, "; "));
  if (outcome.not_wanted) {
    if (!missing.empty()) return {ExitCode::target_missed, "not solved (max iterations = 0), and not as expected: " + clauses + "."};
    return {ExitCode::done, "not solved: max iterations = 0 only counts the unknowns."};
  }
  if (!outcome.solved) return {ExitCode::not_converged, "not converged: " + outcome.finest.why};
  if (params.stopping.rule != complementarity::StoppingRule::adaptive && !outcome.kkt->holds(outcome.kkt_tolerance))
    return {ExitCode::not_converged, "not converged: Newton stopped. " + outcome.kkt->sentence(outcome.kkt_tolerance)};
  if (!missing.empty()) return {ExitCode::target_missed, "solved, but not as expected: " + clauses + "."};
  std::string sentence =
      fmt::format("solved in {} Newton step{} and {} Krylov iteration{}", outcome.at.newton_iterations,
                  outcome.at.newton_iterations == 1 ? "" : "s", outcome.at.linear_iterations, outcome.at.linear_iterations == 1 ? "" : "s");
  if (!outcome.finest.settled) sentence += "; the contact set did not settle; ended by its residual";
  if (outcome.energy_error) sentence += fmt::format("; energy error {:.4e}", *outcome.energy_error);
  return {ExitCode::done, sentence + fmt::format("; contact conditions hold to {:.1e}.", outcome.kkt->worst())};
}

/// The log's table of Newton steps, the history and the checkpoint follow the solve.
class Follow {
 public:
  /// `seconds_before`: spent before a restart. `checkpoint_every`: Newton steps, 0 for never.
  Follow(output::History& history, const CheckpointFile& checkpoint, int checkpoint_every, double seconds_before)
      : history_(history), checkpoint_(checkpoint), checkpoint_every_(checkpoint_every), seconds_before_(seconds_before) {}

  Observer observer(complementarity::StoppingRule rule) {
    Observer observer;
    observer.level = [this](const mesh::Mesh& mesh, int level, const models::Sizes& sizes) { begin_level(mesh, level, sizes); };
    observer.step = [this](const Progress& at, const complementarity::NewtonRecord& record) { step(at, record); };
    if (checkpoint_every_ > 0)
      observer.iterate = [this](const Position& at, const models::Discretization& discretization, const algebra::Vector& X) {
        if (at.newton_iterations % checkpoint_every_ == 0) save(at, discretization, X);
      };
    // under the exact rule nobody looks at linear iterates, and none is formed
    if (rule != complementarity::StoppingRule::exact) observer.check = [this](const Progress& at) { history_.append(row(at)); };
    observer.message = [](const std::string& sentence) { log::warn("{}", sentence); };
    return observer;
  }

  /// Whether the iterate was worth it.
  bool save(const Position& at, const models::Discretization& discretization, const algebra::Vector& X) const {
    const core::Region region("output");
    return checkpoint_.write(at, discretization, X, history_.rows(), seconds());
  }

 private:
  double seconds() const { return seconds_before_ + clock_.seconds(); }
  static void begin_level(const mesh::Mesh& mesh, int level, const models::Sizes& sizes) {
    log::info("level {}: {} cells, {} unknowns ({} in the linear system)", level, mesh.global_cells, sizes.unknowns_all,
              sizes.unknowns_global);
    log::info("{:>6}{:>6}{:>8}{:>10}{:>10}{:>13}", "level", "step", "Krylov", "active", "changed", "residual");
  }
  void step(const Progress& at, const complementarity::NewtonRecord& record) {
    log::info("{:>6}{:>6}{:>8}{:>10}{:>10}{:>13.4e}{}", at.level, record.step, record.linear_iterations, record.active, record.changed,
              record.residual, record.step_length < 1 ? fmt::format("   damped {:.2g}", record.step_length) : "");
    history_.append(row(at));
  }
  output::HistoryRow row(const Progress& at) const {
    output::HistoryRow row;
    row.level = at.level;
    row.newton = at.newton;
    row.linear = at.linear;
    row.active = at.active;
    row.changed = at.changed;
    row.residual = at.residual;
    row.energy_error = at.energy_error;
    row.seconds = seconds();
    return row;
  }

  output::History& history_;
  const CheckpointFile& checkpoint_;
  int checkpoint_every_;
  double seconds_before_;
  core::Stopwatch clock_;
};

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

output::Summary summarize(const RunParams& params, const models::Model& model, const Outcome& outcome, const Verdict& verdict,
                          const mesh::Mesh& mesh, const core::Comm& comm, double total,
                          const std::vector<std::pair<std::string, std::string>>& versions) {
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
  summary.cells = mesh.global_cells;
  summary.unknowns.all = sizes.unknowns_all;
  summary.unknowns.global = sizes.unknowns_global;
  summary.nonzeros = sizes.nonzeros;
  summary.newton_iterations = outcome.at.newton_iterations;
  summary.newton_finest = outcome.at.newton_on_level;
  summary.linear_iterations = outcome.at.linear_iterations;
  summary.energy_error = outcome.energy_error;
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

}  // namespace

void check_served(const RunParams& params) {
  std::vector<std::string> mistakes;
  const std::string no_estimate = " needs an error estimate, which this version does not compute; ";
  if (params.stopping.rule == complementarity::StoppingRule::adaptive)
    mistakes.push_back("stopping/rule: adaptive" + no_estimate + "write exact or inexact.");
  if (params.stopping.estimate.value_or(false))
    mistakes.push_back("stopping/estimate: this" + no_estimate + "write false or leave it out.");
  if (params.stopping.target) mistakes.push_back("stopping/target: this" + no_estimate + "leave it out.");
  if (params.expect.effectivity_between) mistakes.push_back("expect/effectivity between: this" + no_estimate + "leave it out.");

  const method::MethodParams& method = params.method;
  const bool fem = method.name == method::MethodName::fem, dg = method.name == method::MethodName::dg;
  const bool interior = method.name == method::MethodName::hho || (fem && method.degree >= 3);
  if (method.condensation.value_or(false) && !interior)
    mistakes.push_back(
        fmt::format("method/condensation: {} of degree {} has no unknowns that belong to one cell alone; write false or leave it out.",
                    method::to_text(method.name), method.degree));
  if (params.newton.sweeps.value_or(0) > 0 && !method.symmetric())
    mistakes.push_back("newton/sweeps: smoothing needs a symmetric form, which nipg is not; write 0, or method/variant = sipg.");

  const algebra::LinearParams& linear = params.linear;
  const bool cg = linear.solver == algebra::SolverKind::cg;
  const bool muelu = linear.solver != algebra::SolverKind::direct && linear.preconditioner == algebra::PreconditionerKind::muelu;
  const bool full = linear.form == algebra::SystemForm::full && !(method.condensed() && interior);
  const bool nipg = dg && method.variant == method::Variant::nipg;
  if (cg && full)
    mistakes.push_back("linear/form: the full system is not symmetric, so cg can not solve it: write 'reduced', or the solver 'gmres'.");
  if (muelu && full) mistakes.push_back("linear/form: muelu fails on the full system: write 'reduced', or the preconditioner 'ilu'.");
  if (cg && nipg)
    mistakes.push_back(
        "linear/solver: conjugate gradients need a symmetric system, and that of nipg is not: write 'gmres', or the variant 'sipg'.");
  if (muelu && nipg)
    mistakes.push_back(
        "linear/preconditioner: muelu needs a symmetric system, and that of nipg is not: write 'ilu', or the variant 'sipg'.");
  if (!mistakes.empty()) throw core::InputError(fmt::format("{}", fmt::join(mistakes, "\n")));
}

ExitCode run(const RunParams& params, const models::Model& model, const core::Deck& deck, const core::Comm& comm,
             const std::vector<std::pair<std::string, std::string>>& versions, const output::StoredCheckpoint* stored) {
  const core::Stopwatch clock;
  core::reset_regions();
  mesh::Hierarchy hierarchy;
  {
    const core::Region region("mesh");
    hierarchy = mesh::build(params.mesh, comm, deck.folder());
  }
  const mesh::Mesh& finest = hierarchy.finest();
  // what is wrong in the scene on this mesh shows here, before anything is written
  const bool nested = params.newton.start == complementarity::Start::nested;
  for (const auto& mesh : hierarchy.levels)
    if (nested || &mesh == &finest) model.check(mesh, params.output.field_names());
  if (stored) check_restart(*stored, params, hierarchy);

  const output::RunDirectory directory(params.output.directory);
  const bool goes_on = stored && same_directory(*stored, directory.path());
  open(directory, params, goes_on, comm);
  introduce(deck, model, comm, versions, stored);
  const CheckpointFile checkpoint(directory.checkpoint(), params, deck, hierarchy);
  if (!goes_on) checkpoint.remove(comm);

  output::History history =
      output::History::go_on(directory.history(), goes_on ? history_rows_of(*stored) : 0, comm, params.output.history);
  Follow follow(history, checkpoint, params.output.checkpoint_every, stored ? seconds_of(*stored) : 0);
  const Outcome outcome = solve_stationary(model, hierarchy, params, follow.observer(params.stopping.rule), stored);
  const Verdict verdict = judge(params, outcome, finest.global_cells);
  const bool to_be_kept = verdict.code == ExitCode::not_converged || (params.output.checkpoint_every > 0 && !outcome.not_wanted);
  const bool kept = to_be_kept && follow.save(outcome.at, *outcome.discretization, *outcome.X);

  if (!outcome.not_wanted && !params.output.no_fields()) {
    const core::Region region("output");
    output::FieldWriter writer(directory.path(), comm);
    writer.write(outcome.discretization->grid(),
                 outcome.discretization->fields(*outcome.X, outcome.finest.active_set, params.output.field_names()), 0);
    writer.close();
  }
  const auto summary = summarize(params, model, outcome, verdict, *outcome.mesh, comm, clock.seconds(), versions);
  summary.write(directory.summary(), comm);
  log::info("{}", core::region_table(comm, clock.seconds()));
  log::info("results in {}", directory.path());
  if (kept && verdict.code == ExitCode::not_converged) invite(checkpoint.path(), params, outcome);
  log::verdict("{}", verdict.sentence);
  log::close();
  return verdict.code;
}

}  // namespace thixis::drive
