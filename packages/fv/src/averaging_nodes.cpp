#include "averaging_nodes.hpp"

#include <cmath>
#include <utility>

#include "thixis/fv/host.hpp"

namespace thixis::fv {
namespace {

Lists lists(const std::vector<std::vector<LocalIndex>>& of, const std::string& name) {
  Lists out{View<LocalIndex*>("thixis::fv::" + name + "_begin", of.size() + 1), {}};
  const auto begin = Kokkos::create_mirror_view(out.begin);
  begin(0) = 0;
  for (std::size_t i = 0; i < of.size(); ++i) begin(i + 1) = begin(i) + static_cast<LocalIndex>(of[i].size());
  out.entry = View<LocalIndex*>("thixis::fv::" + name, begin(of.size()));
  const auto entry = Kokkos::create_mirror_view(out.entry);
  LocalIndex next = 0;
  for (const auto& list : of)
    for (const LocalIndex i : list) entry(next++) = i;
  Kokkos::deep_copy(out.begin, begin);
  Kokkos::deep_copy(out.entry, entry);
  return out;
}

/// Collects the nodes, and what is around them.
class Collection {
 public:
  Collection(const Grid& grid, const std::vector<bool>& held) : grid_(grid), host_(on_host(grid)), is_held_(held) {
    out_.corners = View<LocalIndex**>("thixis::fv::corner_nodes", grid.owned_cells, grid.corners());
    out_.face_node = View<LocalIndex*>("thixis::fv::face_nodes", grid.faces);
    corners_ = Kokkos::create_mirror_view(out_.corners);
    face_node_ = Kokkos::create_mirror_view(out_.face_node);
  }

  AveragingNodes operator()() {
    add_vertices();
    for (LocalIndex F = 0; F < grid_.faces; ++F)
      face_node_(F) =
          grid_.dimension == 1 ? -1 : add(grid_.global_vertices + grid_.face_id[F], {host_.face_centre(F, 0), host_.face_centre(F, 1)});
    for (LocalIndex K = 0; K < grid_.owned_cells; ++K)
      for (LocalIndex f = host_.cell_face_begin(K); f < host_.cell_face_begin(K + 1); ++f) add_face(K, host_.cell_faces(f));
    finish();
    return std::move(out_);
  }

 private:
  LocalIndex add(GlobalIndex id, const std::array<double, 2>& place) {
    out_.ids.push_back(id);
    places_.push_back(place);
    cells_.emplace_back();
    held_.emplace_back();
    return static_cast<LocalIndex>(places_.size() - 1);
  }

  void add_vertices() {
    std::vector<LocalIndex> node(grid_.vertices, -1);
    for (LocalIndex K = 0; K < grid_.owned_cells; ++K)
      for (int i = 0; i < grid_.corners(); ++i) {
        const LocalIndex v = host_.cell_vertices(K, i);
        if (node[v] < 0) node[v] = add(grid_.vertex_id[v], {host_.vertex(v, 0), host_.vertex(v, 1)});
        corners_(K, i) = node[v];
        cells_[node[v]].push_back(K);
      }
  }

  void add_face(LocalIndex K, LocalIndex F) {
    if (grid_.dimension == 2) cells_[face_node_(F)].push_back(K);
    if (!is_held_[F]) return;
    if (grid_.dimension == 2) held_[face_node_(F)].push_back(F);
    for (int i = 0; i < grid_.corners(); ++i)
      if (lies_on(K, host_.cell_vertices(K, i), F)) held_[corners_(K, i)].push_back(F);
  }

  /// Whether the vertex v of the cell K is one of its face F.
  bool lies_on(LocalIndex K, LocalIndex v, LocalIndex F) const {
    double off = 0;
    for (int c = 0; c < 2; ++c) off += (host_.vertex(v, c) - host_.face_centre(F, c)) * host_.face_normal(F, c);
    const double width = grid_.dimension == 1
                             ? std::abs(host_.vertex(host_.cell_vertices(K, 1), 0) - host_.vertex(host_.cell_vertices(K, 0), 0))
                             : host_.face_area(F);
    return std::abs(off) <= 1e-6 * width;
  }

  void finish() {
    Kokkos::deep_copy(out_.corners, corners_);
    Kokkos::deep_copy(out_.face_node, face_node_);
    out_.cells = lists(cells_, "node_cells");
    out_.held = lists(held_, "node_faces");
    out_.position = View<double* [2]>("thixis::fv::node_position", places_.size());
    const auto position = Kokkos::create_mirror_view(out_.position);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      for (int c = 0; c < 2; ++c) position(i, c) = places_[i][c];
      out_.count.push_back({static_cast<double>(cells_[i].size()), static_cast<double>(held_[i].size())});
    }
    Kokkos::deep_copy(out_.position, position);
  }

  const Grid& grid_;
  const HostGrid host_;
  const std::vector<bool>& is_held_;
  AveragingNodes out_;
  HostView<LocalIndex**> corners_;
  HostView<LocalIndex*> face_node_;
  std::vector<std::array<double, 2>> places_;
  std::vector<std::vector<LocalIndex>> cells_, held_;
};

}  // namespace

AveragingNodes averaging_nodes(const Grid& grid, const std::vector<bool>& held) { return Collection(grid, held)(); }

}  // namespace thixis::fv
