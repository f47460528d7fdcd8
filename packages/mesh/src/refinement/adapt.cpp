#include "thixis/mesh/adapt.hpp"

#include <algorithm>

#include "distribute.hpp"
#include "patches.hpp"
#include "refinement/adaptive.hpp"
#include "refinement/bisect.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::mesh {
namespace {

/// Nothing cut yet. On several ranks, every one makes the uniform levels whole by arithmetic alone, and the first partition again.
Adaptive begin(const Hierarchy& hierarchy) {
  Adaptive state;
  state.uniform_levels = static_cast<int>(hierarchy.levels.size());
  Mesh whole = hierarchy.finest();
  if (whole.comm.size() > 1) {
    whole = *hierarchy.root;
    for (int j = 0; j < state.uniform_levels; ++j) {
      if (j > 0) whole = refine(whole);
      if (j == hierarchy.partitioned) state.trees = std::make_shared<const Mesh>(whole);
    }
    state.tree.resize(whole.cells);
    state.tree_owner = partition(*state.trees, hierarchy.finest().comm);
    const int shift = 2 * (state.uniform_levels - 1 - hierarchy.partitioned);
    for (LocalIndex K = 0; K < whole.cells; ++K) state.tree[K] = K >> shift;
    state.finest = std::make_shared<const Mesh>(whole);
  }
  state.edge = whole.refinement == Refinement::bisection ? std::vector<std::uint8_t>(whole.cells, 0) : longest_faces(whole);
  return state;
}

/// All ranks' marks, as ids in ascending order.
std::vector<GlobalIndex> all_marked(const Mesh& mesh, const std::vector<LocalIndex>& marked) {
  std::vector<GlobalIndex> ids;
  ids.reserve(marked.size());
  for (const LocalIndex K : marked) ids.push_back(mesh.cell_id[K]);
  ids = mesh.comm.gather(ids);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<LocalIndex> numbers_by_id(const std::vector<GlobalIndex>& id, GlobalIndex size) {
  std::vector<LocalIndex> number(size, -1);
  for (std::size_t k = 0; k < id.size(); ++k) number[id[k]] = static_cast<LocalIndex>(k);
  return number;
}

/// Parents as ids become local numbers of the coarse part, -1 where they are not on this rank.
void localize_parents(const Mesh& coarse, Mesh& part) {
  const auto cell = numbers_by_id(coarse.cell_id, coarse.global_cells), vertex = numbers_by_id(coarse.vertex_id, coarse.global_vertices);
  for (LocalIndex& parent : part.cell_parent) parent = cell[parent];
  for (auto& [a, b] : part.vertex_parents) {
    a = vertex[a], b = vertex[b];
    if (a < 0 || b < 0) a = b = -1;
  }
}

/// The part of a whole mesh that this rank sees: the cells of its trees and those that touch them.
Mesh part_of(const Mesh& whole, const core::Comm& comm) {
  std::vector<LocalIndex> kept, others;
  for (LocalIndex K = 0; K < whole.cells; ++K) (whole.cell_owner[K] == comm.rank() ? kept : others).push_back(K);
  const auto owned = static_cast<LocalIndex>(kept.size());
  const auto ghosts = cells_touching(whole, kept, others);
  kept.insert(kept.end(), ghosts.begin(), ghosts.end());
  Mesh part = extract(whole, kept, owned);
  part.comm = comm;
  return part;
}

/// Shares the trees of a new whole level out to the ranks; this rank's part of it.
Mesh share_out(const Mesh& coarse, Mesh whole, Adaptive& state) {
  auto step = std::make_shared<Adaptive::Step>();
  std::vector<LocalIndex> tree(whole.cells), leaves(state.trees->cells, 0);
  for (LocalIndex K = 0; K < whole.cells; ++K) ++leaves[tree[K] = state.tree[whole.cell_parent[K]]];
  state.tree_owner = step->tree_owner = repartition(*state.trees, coarse.comm, leaves, state.tree_owner);

  std::vector<int> owner(whole.cells);
  for (LocalIndex K = 0; K < whole.cells; ++K) owner[K] = step->tree_owner[tree[K]];
  set_owners(std::move(owner), whole);
  Mesh part = part_of(whole, coarse.comm);
  localize_parents(coarse, part);

  step->parent = std::move(whole.cell_parent);
  step->shape = std::move(whole.cell_shape);
  whole.cell_parent_id.clear();
  whole.vertex_parents.clear();
  state.steps.push_back(std::move(step));
  state.tree = std::move(tree);
  state.finest = std::make_shared<const Mesh>(std::move(whole));
  return part;
}

}  // namespace

void adapt(Hierarchy& hierarchy, const std::vector<LocalIndex>& marked) {
  const Mesh& coarse = hierarchy.finest();
  if (coarse.global_cells > 500000000)
    throw core::InputError("adaptive refinement: the mesh has more than 500 million cells; write fewer mesh/refinements.");
  const bool alone = coarse.comm.size() == 1;
  auto state = std::make_shared<Adaptive>(hierarchy.adaptive ? *hierarchy.adaptive : begin(hierarchy));
  Mesh whole = bisect(alone ? coarse : *state->finest, all_marked(coarse, marked), state->edge);
  hierarchy.levels.push_back(alone ? std::move(whole) : share_out(coarse, std::move(whole), *state));
  hierarchy.adaptive = state;
}

}  // namespace thixis::mesh
