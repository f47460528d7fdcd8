#include <fmt/format.h>

#include "model/evolution.hpp"
#include "thixis/core/error.hpp"

namespace thixis::flow {
namespace {

constexpr const char* of_before = " before";
constexpr const char* names_of_owed[components] = {"owed water", "owed hydrogen"};

const std::vector<std::string>& names_of_unknowns() {
  static const std::vector<std::string> names = {"s_g", "P", "chi"};
  return names;
}

}  // namespace

using algebra::Vector;

models::State TwoPhaseEvolution::save(const Vector& X) const {
  models::State state{{}, balance_.save()};
  bound_so_far_.save(state.attributes);
  state.attributes["last_length"] = last_length_;
  add_blocks("", X, state.blocks);
  if (!before_last_.is_null()) add_blocks(of_before, *before_last_, state.blocks);
  add_owed(state.blocks);
  return state;
}

Teuchos::RCP<Vector> TwoPhaseEvolution::restore(const output::StoredCheckpoint& stored) {
  for (const std::string& name : names_of_unknowns())
    if (stored.size(name) != cells())
      throw core::InputError(fmt::format(
          "The checkpoint '{}' belongs to another model or mesh: it holds {}, the deck asks for {} cells; "
          "leave scene and mesh as they were.",
          stored.path(), stored.size(name) < 0 ? fmt::format("no '{}'", name) : fmt::format("{} values of '{}'", stored.size(name), name),
          cells()));
  balance_.restore(stored);
  bound_so_far_.restore(stored);
  last_length_ = stored.number("last_length", 0);
  if (last_length_ > 0) before_last_ = fetched(of_before, stored);
  fetch_owed(stored);
  return fetched("", stored);
}

void TwoPhaseEvolution::add_blocks(const std::string& suffix, const Vector& X, std::vector<output::CheckpointBlock>& blocks) const {
  const auto x = algebra::host_view(X);
  for (int u = 0; u < unknowns_per_cell; ++u) {
    output::CheckpointBlock block{names_of_unknowns()[u] + suffix, owned_ids(), {}};
    for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) block.values.push_back(x(unknowns_per_cell * K + u));
    blocks.push_back(std::move(block));
  }
}

Teuchos::RCP<Vector> TwoPhaseEvolution::fetched(const std::string& suffix, const output::StoredCheckpoint& stored) const {
  const auto X = Teuchos::rcp(new Vector(flow_.map()));
  const auto x = algebra::host_overwrite(*X);
  for (int u = 0; u < unknowns_per_cell; ++u) {
    const auto values = stored.fetch_finite(names_of_unknowns()[u] + suffix, owned_ids());
    for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) x(unknowns_per_cell * K + u) = values[K];
  }
  return X;
}

void TwoPhaseEvolution::add_owed(std::vector<output::CheckpointBlock>& blocks) const {
  const auto owed = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), owed_);
  for (int c = 0; c < components; ++c) {
    output::CheckpointBlock block{names_of_owed[c], owned_ids(), {}};
    for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) block.values.push_back(owed(K, c));
    blocks.push_back(std::move(block));
  }
}

void TwoPhaseEvolution::fetch_owed(const output::StoredCheckpoint& stored) const {
  const auto owed = Kokkos::create_mirror_view(owed_);
  for (int c = 0; c < components; ++c) {
    if (stored.size(names_of_owed[c]) != cells()) return;
    const auto values = stored.fetch(names_of_owed[c], owned_ids());
    for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) owed(K, c) = values[K];
  }
  Kokkos::deep_copy(owed_, owed);
}

std::vector<GlobalIndex> TwoPhaseEvolution::owned_ids() const {
  const auto& ids = flow_.grid().cell_id;
  return {ids.begin(), ids.begin() + flow_.grid().owned_cells};
}

}  // namespace thixis::flow
