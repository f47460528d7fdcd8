#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
    if (!missing.empty()) return {ExitCode::target_missed, "not solved (max iterations = 0), and expected otherwise: " + clauses + "."};
    return {ExitCode::done, "not solved: max iterations = 0 only counts the unknowns."};
  }
  if (!outcome.solved) return {ExitCode::not_converged, "not converged: " + outcome.finest.why};
  const double tolerance = params.stopping.kkt_tolerance;
  if (params.stopping.rule != complementarity::StoppingRule::adaptive && !outcome.kkt->holds(tolerance))
    return {ExitCode::not_converged, "not converged: Newton stopped, but " + outcome.kkt->sentence(tolerance)};
  if (!missing.empty()) return {ExitCode::target_missed, "solved, but not as expected: " + clauses + "."};
  std::string sentence =
      fmt::format("solved in {} Newton steps and {} Krylov iterations", outcome.newton_iterations, outcome.linear_iterations);
  if (outcome.energy_error) sentence += fmt::format("; energy error {:.4e}", *outcome.energy_error);
  return {ExitCode::done, sentence + fmt::format("; contact conditions hold to {:.1e}.", outcome.kkt->worst())};
}

/// The log's table of Newton steps and the history file follow the solve.
class Follow {
 public:
  Follow(output::History& history) : history_(history) {}

  Observer observer() {
    Observer observer;
    observer.level = [this](const mesh::Mesh& mesh, int level, const models::Sizes& sizes) { begin_level(mesh, level, sizes); };
    observer.step = [this](const Progress& at, const complementarity::NewtonRecord& record) { step(at, record); };
    observer.check = [this](const Progress& at) { history_.append(row(at)); };
    observer.message = [](const std::string& sentence) { log::warn("{}", sentence); };
    return observer;
  }

 private:
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
    row.seconds = clock_.seconds();
    return row;
  }

  output::History& history_;
  core::Stopwatch clock_;
};

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
  summary.newton_iterations = outcome.newton_iterations;
  summary.newton_finest = outcome.finest.steps;
  summary.linear_iterations = outcome.linear_iterations;
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
  const std::string no_estimate = " needs an error estimate, which this version does not compute; ";
  if (params.stopping.rule == complementarity::StoppingRule::adaptive)
    throw core::InputError("stopping/rule: adaptive" + no_estimate + "write exact or inexact.");
  if (params.stopping.estimate.value_or(false))
    throw core::InputError("stopping/estimate: this" + no_estimate + "write false or leave it out.");
  if (params.stopping.target) throw core::InputError("stopping/target: this" + no_estimate + "leave it out.");
  if (params.expect.effectivity_between) throw core::InputError("expect/effectivity between: this" + no_estimate + "leave it out.");
  if (params.linear.solver == algebra::SolverKind::cg && params.linear.form == algebra::SystemForm::full)
    throw core::InputError(
        "linear/solver: the full system is not symmetric, so cg can not solve it; write form = reduced, or solver = gmres.");
  if (params.linear.preconditioner == algebra::PreconditionerKind::muelu && params.linear.form == algebra::SystemForm::full)
    throw core::InputError("linear/preconditioner: muelu works on the reduced system only; write form = reduced, or preconditioner = ilu.");
}

ExitCode run(const RunParams& params, const models::Model& model, const core::Deck& deck, const core::Comm& comm,
             const std::vector<std::pair<std::string, std::string>>& versions) {
  const core::Stopwatch clock;
  core::reset_regions();
  mesh::Hierarchy hierarchy;
  {
    const core::Region region("mesh");
    hierarchy = mesh::build(params.mesh, comm, deck.folder());
  }
  const mesh::Mesh& finest = hierarchy.finest();
  // what is wrong in the scene on this mesh shows here, before anything is written
  model.check(finest, params.output.field_names());

  const output::RunDirectory directory(params.output.directory);
  directory.create(comm);
  directory.write_deck(core::to_xml(RunParams::schema(), params), comm);
  comm.on_root([&] { log::open(directory.log()); });
  log::info("{}: model {}{}, on {} {}", deck.file(), model.name(), model.case_name().empty() ? "" : ", case " + model.case_name(),
            comm.size(), comm.size() == 1 ? "rank" : "ranks");
  for (const auto& [name, version] : versions) log::detail("{:<16}{}", name, version);

  output::History history(directory.history(), comm, params.output.history);
  Follow follow(history);
  const Outcome outcome = solve_stationary(model, hierarchy, params, follow.observer());
  const Verdict verdict = judge(params, outcome, finest.global_cells);

  if (!outcome.not_wanted && !params.output.no_fields()) {
    const core::Region region("output");
    output::FieldWriter writer(directory.path(), comm);
    writer.write(*outcome.mesh, outcome.discretization->fields(*outcome.X, outcome.finest.active_set, params.output.field_names()), 0);
    writer.close();
  }
  const auto summary = summarize(params, model, outcome, verdict, *outcome.mesh, comm, clock.seconds(), versions);
  summary.write(directory.summary(), comm);
  log::info("{}", core::region_table(comm, clock.seconds()));
  log::info("results in {}", directory.path());
  log::verdict("{}", verdict.sentence);
  log::close();
  return verdict.code;
}

}  // namespace thixis::drive
