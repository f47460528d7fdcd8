#include "follow/results.hpp"

#include <fmt/format.h>

#include <Kokkos_Core.hpp>
#include <filesystem>

#include "thixis/core/log.hpp"
#include "thixis/core/memory.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::drive {
namespace log = core::log;

namespace {

/// A value for each owned cell of the mesh, on the cells of the grid that show it: as many of them for each cell.
output::FieldData on_cells(const std::string& name, const std::vector<double>& values, std::size_t shown) {
  output::FieldData field{name, output::Centre::cell, {}};
  const std::size_t pieces = values.empty() ? 0 : shown / values.size();
  for (const double value : values) field.values.insert(field.values.end(), pieces, value);
  return field;
}

/// The way from `folder` to a file that is given relative to `start`.
std::string from_folder(const std::string& folder, const std::string& start, const std::string& file) {
  namespace fs = std::filesystem;
  if (file.empty() || fs::path(file).is_absolute()) return file;
  std::error_code error;
  const fs::path way = fs::proximate(fs::path(start) / file, folder, error);
  return error ? fs::absolute(fs::path(start) / file).string() : way.string();
}

}  // namespace

void open(output::RunDirectory& directory, const RunParams& params, const core::Deck& deck, bool goes_on, const core::Comm& comm) {
  directory.create(comm);
  RunParams as_run = params;
  as_run.mesh.file = from_folder(directory.path(), deck.folder(), params.mesh.file);
  directory.write_deck(as_run.as_deck(), comm);
  comm.on_root([&] { log::open(directory.log(), goes_on ? log::Old::keep : log::Old::overwrite); });
}

void introduce(const core::Deck& deck, const models::Model& model, const core::Comm& comm, const Versions& versions) {
  log::info("{}: model {}{}, on {} {}", deck.file(), model.name(), model.case_name().empty() ? "" : ", case " + model.case_name(),
            comm.size(), comm.size() == 1 ? "rank" : "ranks");
  std::string text;
  for (const auto& [name, version] : versions) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, version);
  log::info("{}", text);
}

std::string estimate_header() { return fmt::format("{:>12}{:>12}{:>12}{:>12}", "eta_disc", "eta_lin", "eta_alg", "eta"); }

std::string estimate_columns(const std::optional<complementarity::Estimate>& eta) {
  if (!eta) return "";
  return fmt::format("{:>12.3e}{:>12.3e}{:>12.3e}{:>12.3e}", eta->discretization, eta->linearization, eta->algebraic, eta->total);
}

void set_estimate(output::HistoryRow& row, const std::optional<complementarity::Estimate>& eta) {
  if (!eta) return;
  row.eta_disc = eta->discretization;
  row.eta_lin = eta->linearization;
  row.eta_alg = eta->algebraic;
  row.eta_total = eta->total;
  row.eta_time = eta->time;
  row.promise = to_text(eta->promise);
}

void add_estimates(const OutputParams& params, const models::CellEstimates& cells, const output::Grid& grid,
                   std::vector<output::FieldData>& fields) {
  for (const auto& name : params.estimate_names())
    fields.push_back(on_cells(name,
                              name == "eta_disc"  ? cells.discretization
                              : name == "eta_lin" ? cells.linearization
                                                  : cells.algebraic,
                              grid.cells()));
}

output::SummaryEstimate parts(const complementarity::Estimate& eta, const std::vector<std::string>& doubts) {
  const bool open = eta.promise == complementarity::Promise::up_to_quadrature;
  return {
      eta.total, eta.discretization, eta.linearization, eta.algebraic, to_text(eta.promise), open ? doubts : std::vector<std::string>(), {},
      eta.time};
}

void say_doubts(const std::optional<complementarity::Estimate>& eta, const std::vector<std::string>& doubts) {
  if (!eta || eta->promise != complementarity::Promise::up_to_quadrature || doubts.empty()) return;
  log::info("the bound is {}: {}", to_text(eta->promise), fmt::join(doubts, "; "));
}

namespace {

/// Verdict, model, method, ranks, times, memory, versions.
output::Summary begun(const RunParams& params, const models::Model& model, const Verdict& verdict, const core::Comm& comm, double seconds,
                      const Versions& versions) {
  output::Summary summary;
  summary.verdict = verdict.sentence;
  summary.exit_code = static_cast<int>(verdict.code);
  summary.model = model.name();
  summary.problem_case = model.case_name();
  summary.method = params.method.name;
  summary.degree = params.method.degree;
  summary.ranks = comm.size();
  summary.threads = Kokkos::DefaultExecutionSpace::concurrency();
  const auto longest = [&](const char* region) { return comm.max(core::seconds(region)); };
  summary.time = {comm.max(seconds), longest("mesh"),     longest("assembly"), longest("preconditioner"),
                  longest("linear"), longest("estimate"), longest("output")};
  summary.memory_mb = comm.sum(core::peak_memory_mb());
  summary.versions = versions;
  return summary;
}

}  // namespace

output::Summary summarize(const RunParams& params, const models::Model& model, const Found& found, const Verdict& verdict,
                          const core::Comm& comm, double seconds, const Versions& versions) {
  output::Summary summary = begun(params, model, verdict, comm, seconds, versions);
  summary.cells = found.cells;
  summary.unknowns.all = found.sizes.unknowns_all;
  summary.unknowns.global = found.sizes.unknowns_global;
  summary.nonzeros = found.sizes.nonzeros;
  summary.newton_iterations = found.newton_iterations.value_or(0);
  summary.newton_finest = found.newton_finest.value_or(0);
  summary.linear_iterations = found.linear_iterations.value_or(0);
  summary.in_time = found.in_time;
  summary.energy_error = found.energy_error;
  summary.energy_norm = found.energy_norm;
  summary.effectivity = found.effectivity();
  if (found.estimate) summary.estimate = parts(*found.estimate, found.doubts);
  if (found.published) {
    summary.estimate_published = parts(found.published->parts);
    summary.estimate_published->terms = found.published->terms;
    if (found.energy_error) summary.effectivity_published = found.published->parts.total / *found.energy_error;
  }
  if (found.kkt) {
    const auto& kkt = *found.kkt;
    summary.kkt = {kkt.infeasible, kkt.negative, kkt.complementary, kkt.between_nodes, kkt.equilibrium};
  }
  summary.active_points = found.active;
  summary.of_model = found.summary;
  return summary;
}

core::ExitCode conclude(const output::RunDirectory& directory, const Verdict& verdict, const std::string& invitation,
                        const core::Comm& comm, double seconds) {
  log::info("{}", core::region_table(comm, seconds));
  log::info("results in {}", directory.path());
  if (!invitation.empty()) log::info("{}", invitation);
  log::verdict("{}", verdict.sentence);
  log::close();
  return verdict.code;
}

}  // namespace thixis::drive
