#include "follow/follow.hpp"

#include <fmt/format.h>

#include "follow/results.hpp"
#include "thixis/core/log.hpp"

namespace thixis::drive {
namespace log = core::log;

Observer Follow::observer() {
  Observer observer;
  observer.level = [this](const mesh::Mesh& mesh, int level, const models::Sizes& sizes) { begin_level(mesh, level, sizes); };
  observer.step = [this](const Progress& at, const complementarity::NewtonRecord& record) { step(at, record); };
  observer.level_end = [this](const Progress& at) { end_level(at); };
  observer.refined = [this](int level, const std::vector<GlobalIndex>& marked) { refined(level, marked); };
  const int every = params_.output.checkpoint_every;
  if (every > 0)
    observer.iterate = [this, every](const Position& at, const models::Discretization& discretization, const algebra::Vector& X) {
      if (at.newton_iterations % every == 0) save(at, discretization, X);
    };
  if (sees_linear_iterates()) observer.check = [this](const Progress& at) { history_.append(row_of(at)); };
  observer.message = [](const std::string& sentence) { log::warn("{}", sentence); };
  return observer;
}

bool Follow::save(const Position& at, const models::Discretization& discretization, const algebra::Vector& X) const {
  const core::Region region("output");
  auto of_run = stored_by(at, written());
  of_run["cells"] = static_cast<double>(discretization.cells());  // which check_restart compares
  return checkpoint_.write(discretization, X, at.level, std::move(of_run));
}

void Follow::begin_level(const mesh::Mesh& mesh, int level, const models::Sizes& sizes) const {
  log::info("level {}: {} cells, {} unknowns ({} in the linear system)", level, mesh.global_cells, sizes.unknowns_all,
            sizes.unknowns_global);
  const std::string header = params_.estimated() ? estimate_header() : "";
  log::info("{:>6}{:>6}{:>8}{:>10}{:>10}{:>13}{}", "level", "step", "Krylov", "active", "changed", "residual", header);
}

void Follow::end_level(const Progress& at) {
  log::info("{:>6}{:>6}{:>41}{}", at.level, "end", "", estimate_columns(at.estimate));
  history_.append(row_of(at));
}

void Follow::step(const Progress& at, const complementarity::NewtonRecord& record) {
  log::info("{:>6}{:>6}{:>8}{:>10}{:>10}{:>13.4e}{}{}", at.level, record.step, record.linear_iterations, record.active, record.changed,
            record.residual, estimate_columns(at.estimate),
            record.step_length < 1 ? fmt::format("   damped {:.2g}", record.step_length) : "");
  history_.append(row_of(at));
}

void Follow::refined(int level, const std::vector<GlobalIndex>& marked) {
  log::info("level {}: {} cells are marked to be refined", level - 1, marked.size());
  checkpoint_.refined(level, marked);
}

output::HistoryRow Follow::row_of(const Progress& at) const {
  output::HistoryRow row = Follower::row(at.estimate, at.energy_error);
  row.level = at.level;
  row.newton = at.newton;
  row.linear = at.linear;
  row.active = at.active;
  row.changed = at.changed;
  row.residual = at.residual;
  return row;
}

}  // namespace thixis::drive
