#include "checks/membrane_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::membranes {
namespace {

/// Disjoint sets, each known by its lowest member.
class Sets {
 public:
  GlobalIndex lowest(GlobalIndex member) {
    GlobalIndex root = member;
    for (auto next = parent_.find(root); next != parent_.end() && next->second != root; next = parent_.find(root)) root = next->second;
    for (GlobalIndex at = member; at != root;) {
      const GlobalIndex next = parent_[at];
      parent_[at] = root;
      at = next;
    }
    return root;
  }
  void join(GlobalIndex a, GlobalIndex b) {
    const auto [low, high] = std::minmax({lowest(a), lowest(b)});
    parent_[high] = low;
  }

 private:
  std::map<GlobalIndex, GlobalIndex> parent_;  ///< a member that is not there is alone
};

/// The same for 0 … count - 1.
class LocalSets {
 public:
  explicit LocalSets(LocalIndex count) : parent_(count) {
    for (LocalIndex i = 0; i < count; ++i) parent_[i] = i;
  }
  LocalIndex lowest(LocalIndex i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(LocalIndex a, LocalIndex b) {
    const auto [low, high] = std::minmax({lowest(a), lowest(b)});
    parent_[high] = low;
  }

 private:
  std::vector<LocalIndex> parent_;
};

/// The pieces of the whole mesh as one rank knows them: the lowest id of a cell of its own in each piece of its own cells.
class Pieces {
 public:
  Pieces(const Boundary& boundary, const mesh::Mesh& mesh) : mesh_(mesh), host_(mesh::on_host(mesh)) {
    const auto own = of_own_cells();
    std::vector<GlobalIndex> links = across_ranks(own);
    links = mesh.comm.gather(links);
    for (std::size_t i = 0; i + 1 < links.size(); i += 2) sets_.join(links[i], links[i + 1]);
    label_.resize(own.size());
    for (std::size_t K = 0; K < own.size(); ++K) label_[K] = sets_.lowest(own[K]);
    find_free(boundary);
  }

  /// The pieces that nothing holds.
  const std::set<GlobalIndex>& free() const { return free_; }

  /// "at (2, 0), whose boundary is 'free'". Collective.
  std::string place(GlobalIndex piece) const {
    std::vector<double> at(2, -std::numeric_limits<double>::infinity());
    std::vector<int> tags(mesh_.tags.size(), 0);
    for (LocalIndex K = 0; K < mesh_.owned_cells; ++K) {
      if (label_[K] != piece) continue;
      if (mesh_.cell_id[K] == piece) at = first_vertex(K);
      for (int i = 0; i < 3; ++i)
        if (const LocalIndex tag = host_.face_tag(host_.cell_faces(K, i)); tag >= 0) tags[tag] = 1;
    }
    mesh_.comm.max(at);
    mesh_.comm.max(tags);
    std::string names;
    for (std::size_t tag = 0; tag < tags.size(); ++tag)
      if (tags[tag] != 0) names += (names.empty() ? "'" : ", '") + mesh_.tags[tag] + "'";
    return fmt::format("at ({:.6g}, {:.6g}), whose boundary is {}", at[0], at[1], names);
  }

 private:
  /// The vertex of the lowest id.
  std::vector<double> first_vertex(LocalIndex K) const {
    LocalIndex first = host_.cell_vertices(K, 0);
    for (int i = 1; i < 3; ++i)
      if (const LocalIndex v = host_.cell_vertices(K, i); mesh_.vertex_id[v] < mesh_.vertex_id[first]) first = v;
    return {host_.coordinates(first, 0), host_.coordinates(first, 1)};
  }

  LocalIndex neighbour(LocalIndex K, int i) const { return mesh::neighbour(host_.face_cells, host_.cell_faces(K, i), K); }

  /// For each own cell the lowest id in its piece of this rank.
  std::vector<GlobalIndex> of_own_cells() const {
    const LocalIndex cells = mesh_.owned_cells;
    LocalSets sets(cells);
    for (LocalIndex K = 0; K < cells; ++K)
      for (int i = 0; i < 3; ++i)
        if (const LocalIndex other = neighbour(K, i); other >= 0 && other < cells) sets.join(K, other);
    std::vector<GlobalIndex> lowest(cells, std::numeric_limits<GlobalIndex>::max()), label(cells);
    for (LocalIndex K = 0; K < cells; ++K) {
      GlobalIndex& id = lowest[sets.lowest(K)];
      id = std::min(id, mesh_.cell_id[K]);
    }
    for (LocalIndex K = 0; K < cells; ++K) label[K] = lowest[sets.lowest(K)];
    return label;
  }

  /// Pairs of pieces of different ranks that are one.
  std::vector<GlobalIndex> across_ranks(const std::vector<GlobalIndex>& own) const {
    const LocalIndex cells = mesh_.owned_cells;
    std::vector<std::pair<LocalIndex, LocalIndex>> touching;  // own cell, cell of another rank
    for (LocalIndex K = 0; K < cells; ++K)
      for (int i = 0; i < 3; ++i)
        if (const LocalIndex other = neighbour(K, i); other >= cells) touching.emplace_back(K, other);
    const auto owned = algebra::map_of({mesh_.cell_id.begin(), mesh_.cell_id.begin() + cells}, mesh_.comm);
    const auto all = algebra::map_of(mesh_.cell_id, mesh_.comm);
    algebra::Vector labels(owned), everywhere(all);
    {
      const auto out = algebra::host_overwrite(labels);
      for (LocalIndex K = 0; K < cells; ++K) out(K) = static_cast<double>(own[K]);
    }
    everywhere.doImport(labels, algebra::Import(owned, all), Tpetra::INSERT);
    std::set<std::pair<GlobalIndex, GlobalIndex>> links;
    const auto label = algebra::host_view(everywhere);
    for (const auto& [K, other] : touching) links.emplace(own[K], static_cast<GlobalIndex>(label(other)));
    std::vector<GlobalIndex> flat;
    for (const auto& [a, b] : links) flat.insert(flat.end(), {a, b});
    return flat;
  }

  void find_free(const Boundary& boundary) {
    std::set<GlobalIndex> here, held;
    for (LocalIndex K = 0; K < mesh_.owned_cells; ++K) {
      here.insert(label_[K]);
      for (int i = 0; i < 3; ++i)
        if (const LocalIndex tag = host_.face_tag(host_.cell_faces(K, i)); tag >= 0 && boundary.dirichlet[tag]) held.insert(label_[K]);
    }
    // a piece is free if no rank that has cells of it holds it
    std::vector<GlobalIndex> free;
    std::set_difference(here.begin(), here.end(), held.begin(), held.end(), std::back_inserter(free));
    const auto candidates = mesh_.comm.gather(free);
    free_.insert(candidates.begin(), candidates.end());
    std::vector<GlobalIndex> held_elsewhere;
    std::set_intersection(free_.begin(), free_.end(), held.begin(), held.end(), std::back_inserter(held_elsewhere));
    for (const GlobalIndex piece : mesh_.comm.gather(held_elsewhere)) free_.erase(piece);
  }

  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
  Sets sets_;
  std::vector<GlobalIndex> label_;  ///< of own cells: the lowest id in the piece
  std::set<GlobalIndex> free_;
};

}  // namespace

void check_pieces(const MembraneScene& scene, const Boundary& boundary, const mesh::Mesh& mesh) {
  const bool all_held = std::all_of(boundary.dirichlet.begin(), boundary.dirichlet.end(), [](bool held) { return held; });
  if (all_held) return;  // every piece has a boundary
  const Pieces pieces(boundary, mesh);
  if (pieces.free().empty()) return;
  const std::size_t others = pieces.free().size() - 1;
  throw core::InputError(
      fmt::format("scene/boundary: nothing holds the piece of the mesh {}{}: no part of it has kind dirichlet, {}; hold each piece "
                  "somewhere, or leave it "
                  "out of the mesh.",
                  pieces.place(*pieces.free().begin()), others > 0 ? fmt::format(" (and {} more)", others) : "",
                  scene.obstacle ? "and a membrane that nothing but the obstacle can hold is not served"
                                 : "so the membranes are free to float away there"));
}

}  // namespace thixis::membranes
