#include <fmt/format.h>

#include <unordered_set>

#include "in_time/parabolic_evolution.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/mesh/adapt.hpp"

namespace thixis::membranes {
namespace {

constexpr const char* of_before = " before";

std::string marks_of(int level) { return fmt::format("marked for level {}", level); }

}  // namespace

using algebra::Vector;

models::State ParabolicEvolution::save(const Vector& X) const {
  std::map<std::string, double> sums = {{"data_time", on_mesh_->time()},
                                        {"squared_energy_error", squared_error_},
                                        {"bounded", bounded_},
                                        {"last_length", last_.X.is_null() ? 0 : last_.length}};
  if (bounded_) sums.merge(bound_ ? bound_->sums() : std::map<std::string, double>(restored_bound_));
  auto blocks = on_mesh_->save(X);
  if (!last_.X.is_null())
    for (auto& block : on_mesh_->save(*last_.X, of_before)) blocks.push_back(std::move(block));
  for (const auto& [level, marked] : marked_) blocks.push_back(output::list_block(marks_of(level), marked, comm().root()));
  return {std::move(blocks), sums};
}

Teuchos::RCP<Vector> ParabolicEvolution::restore(const output::StoredCheckpoint& stored) {
  replay(stored);
  auto X = on_mesh_->restore(stored);
  last_.length = stored.number("last_length", 0);
  last_.X = last_.length > 0 ? on_mesh_->restore(stored, of_before) : Teuchos::null;
  on_mesh_->move_to(stored.number("data_time", 0));
  squared_error_ = stored.number("squared_energy_error", 0);
  standing_ = Standing::at_rest;
  step_.estimated = false;
  bounded_ = stored.count("bounded", 1) != 0;
  restored_bound_.clear();
  for (const std::string& name : bound::StepBound::names_of_sums())
    if (bounded_) restored_bound_[name] = stored.number(name);
  if (bound_ && bounded_) bound_->restore(restored_bound_);
  return X;
}

/// During a step begun X is what it began with, else the X at its end. The functions in the cells are the same on the finer mesh, but for
/// boundary values: those are the interpolant of the data there.
Teuchos::RCP<Vector> ParabolicEvolution::refine(const std::vector<GlobalIndex>& marked, const Vector& X) {
  const double t = step_is_open() ? step_.time.begin : on_mesh_->time();
  on_mesh_->move_to(t);
  const Pair coarse_u = at(X);
  append(marked);
  const auto on_coarse = std::move(on_mesh_);
  const auto coarse_bound = std::move(bound_);
  go_to_finest();
  on_mesh_->move_to(t);
  restored_bound_.clear();
  const auto fine_X = on_mesh_->from_coarse(*on_coarse, X);
  levels_->keep_from(finest_level());
  bounded_ = bounded_ && coarse_bound;
  if (bounded_) {
    bound_ = make_bound(t);
    bound_->take_over(*coarse_bound, t, coarse_u.u, at(*fine_X).u);
  }
  return fine_X;
}

/// A level of the hierarchy from the finest one and the ids of its cells to be refined.
void ParabolicEvolution::append(const std::vector<GlobalIndex>& marked) {
  const core::Region region("mesh");
  const std::unordered_set<GlobalIndex> ids(marked.begin(), marked.end());
  const mesh::Mesh& coarse = hierarchy_.finest();
  std::vector<LocalIndex> cells;
  for (LocalIndex K = 0; K < coarse.owned_cells; ++K)
    if (ids.count(coarse.cell_id[K]) > 0) cells.push_back(K);
  mesh::adapt(hierarchy_, cells);
  marked_[finest_level()] = marked;
}

/// Nothing of the mesh before is kept.
void ParabolicEvolution::go_to_finest() {
  on_mesh_ = make_level();
  bound_.reset();
  step_ = {};
  last_ = {};
  rate_ = 0;
  standing_ = Standing::at_rest;
}

/// The meshes that refinement had added when the checkpoint was written.
void ParabolicEvolution::replay(const output::StoredCheckpoint& stored) {
  const auto have = hierarchy_.levels.size();
  for (int level = static_cast<int>(have); stored.size(marks_of(level)) >= 0; ++level) append(stored.fetch_list(marks_of(level)));
  if (hierarchy_.levels.size() == have) return;
  go_to_finest();
  levels_->keep_from(finest_level());
}

std::unique_ptr<MembraneLevel> ParabolicEvolution::make_level() const {
  const core::Region region("assembly");
  return std::make_unique<MembraneLevel>(scene_, origin_, levels_, finest_level(), linear_);
}

}  // namespace thixis::membranes
