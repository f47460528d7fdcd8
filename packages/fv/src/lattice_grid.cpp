#include <algorithm>
#include <cmath>

#include "grids.hpp"
#include "thixis/fv/host.hpp"

namespace thixis::fv {
namespace {

/// Cells (a, b) with a_begin <= a < a_end, b_begin <= b < b_end.
struct Box {
  GlobalIndex a_begin = 0, a_end = 0, b_begin = 0, b_end = 0;
  GlobalIndex width() const { return a_end - a_begin; }
  GlobalIndex height() const { return b_end - b_begin; }
  bool empty() const { return width() == 0 || height() == 0; }
  bool holds(GlobalIndex a, GlobalIndex b) const { return a_begin <= a && a < a_end && b_begin <= b && b < b_end; }
};

struct Builder {
  Lattice whole;
  Split parts;
  Box owned, all;  ///< all: with one more cell on every side
  Grid grid;
  HostGrid host;
  std::vector<LocalIndex> cell_number;  ///< local, of the cells of `all` row by row

  Builder(const Lattice& lattice, const core::Comm& comm) : whole(lattice), parts(split(lattice, comm.size())) {
    grid.comm = comm;
    grid.dimension = whole.dimension;
    const int k_a = comm.rank() % parts.parts_a, k_b = comm.rank() / parts.parts_a;
    owned = {begin(whole.n_a, parts.parts_a, k_a), begin(whole.n_a, parts.parts_a, k_a + 1), begin(whole.n_b, parts.parts_b, k_b),
             begin(whole.n_b, parts.parts_b, k_b + 1)};
    if (owned.empty()) owned = {};
    all = owned;
    if (!owned.empty())
      all = {std::max<GlobalIndex>(owned.a_begin - 1, 0), std::min(owned.a_end + 1, whole.n_a), std::max<GlobalIndex>(owned.b_begin - 1, 0),
             std::min(owned.b_end + 1, whole.n_b)};
  }

  LocalIndex cell(GlobalIndex a, GlobalIndex b) const {
    return all.holds(a, b) ? cell_number[(b - all.b_begin) * all.width() + a - all.a_begin] : -1;
  }
  LocalIndex vertices_per_row() const { return static_cast<LocalIndex>(grid.dimension == 1 ? 1 : all.width() + 1); }
  LocalIndex vertex(GlobalIndex a, GlobalIndex b) const {
    return static_cast<LocalIndex>((b - all.b_begin) * vertices_per_row() + a - all.a_begin);
  }
  LocalIndex faces_per_row() const { return static_cast<LocalIndex>(grid.dimension == 1 ? 1 : 2 * owned.width() + 1); }
  LocalIndex face_below(GlobalIndex a, GlobalIndex b) const {
    return static_cast<LocalIndex>((b - owned.b_begin) * faces_per_row() + a - owned.a_begin);
  }
  LocalIndex face_beside(GlobalIndex a, GlobalIndex b) const { return face_below(a, b) + static_cast<LocalIndex>(owned.width()); }

  void allocate_all() {
    grid.global_cells = whole.cells();
    grid.global_faces = whole.faces();
    grid.global_vertices = whole.vertices();
    grid.tags = {"left", "right"};
    if (grid.dimension == 2) grid.tags.insert(grid.tags.end(), {"bottom", "top"});
    if (!owned.empty()) {
      grid.owned_cells = static_cast<LocalIndex>(owned.width() * owned.height());
      grid.cells = static_cast<LocalIndex>(all.width() * all.height());
      grid.faces = static_cast<LocalIndex>(faces_per_row() * owned.height() + owned.width());
      grid.vertices = static_cast<LocalIndex>(vertices_per_row() * (all.height() + 1));
    }
    host = allocate(grid, 2 * grid.dimension);
  }

  void add_cell(LocalIndex K, GlobalIndex a, GlobalIndex b) {
    const auto x = whole.point(static_cast<double>(a) + 0.5, static_cast<double>(b) + 0.5);
    for (int d = 0; d < 2; ++d) host.centre(K, d) = host.barycentre(K, d) = x[d];
    host.volume(K) = whole.step_a() * whole.step_b();
    host.diameter(K) = grid.dimension == 1 ? whole.step_b() : std::hypot(whole.step_a(), whole.step_b());
    grid.cell_id[K] = whole.cell(a, b);
    grid.cell_owner[K] = part_of(whole.n_b, parts.parts_b, b) * parts.parts_a + part_of(whole.n_a, parts.parts_a, a);
    add_corners(K, a, b);
  }

  void add_corners(LocalIndex K, GlobalIndex a, GlobalIndex b) {
    host.cell_vertices(K, 0) = vertex(a, b);
    if (grid.dimension == 1) {
      host.cell_vertices(K, 1) = vertex(a, b + 1);
      return;
    }
    const bool along_x = whole.axis_a == 0;
    host.cell_vertices(K, 1) = along_x ? vertex(a + 1, b) : vertex(a, b + 1);
    host.cell_vertices(K, 2) = vertex(a + 1, b + 1);
    host.cell_vertices(K, 3) = along_x ? vertex(a, b + 1) : vertex(a + 1, b);
  }

  void add_cells() {
    cell_number.resize(grid.cells);
    LocalIndex K = 0;
    for (const bool mine : {true, false})
      for (GlobalIndex b = all.b_begin; b < all.b_end; ++b)
        for (GlobalIndex a = all.a_begin; a < all.a_end; ++a) {
          if (owned.holds(a, b) != mine) continue;
          cell_number[(b - all.b_begin) * all.width() + a - all.a_begin] = K;
          add_cell(K++, a, b);
        }
  }

  void add_vertices() {
    for (GlobalIndex b = all.b_begin; b <= all.b_end; ++b)
      for (LocalIndex k = 0; k < vertices_per_row(); ++k) {
        const GlobalIndex a = all.a_begin + k;
        const LocalIndex v = vertex(a, b);
        const auto x = whole.point(static_cast<double>(a), static_cast<double>(b));
        for (int d = 0; d < 2; ++d) host.vertex(v, d) = x[d];
        grid.vertex_id[v] = whole.vertex(a, b);
      }
  }

  /// The face orthogonal to `axis` between two cells, -1 where there is none, `step` apart.
  void add_face(LocalIndex F, int axis, LocalIndex before, LocalIndex after, double step, double area,
                const std::array<double, 2>& centre) {
    const bool first = before < 0, boundary = first || after < 0;
    host.face_cells(F, 0) = first ? after : before;
    host.face_cells(F, 1) = boundary ? -1 : after;
    host.face_area(F) = area;
    host.face_distance(F) = boundary ? step / 2 : step;
    host.face_tag(F) = boundary ? 2 * axis + (first ? 0 : 1) : -1;
    for (int d = 0; d < 2; ++d) {
      host.face_centre(F, d) = centre[d];
      host.face_normal(F, d) = d != axis ? 0 : first ? -1 : 1;
    }
  }

  void add_face_below(GlobalIndex a, GlobalIndex b) {
    const LocalIndex F = face_below(a, b);
    grid.face_id[F] = whole.face_below(a, b);
    add_face(F, whole.axis_b, cell(a, b - 1), cell(a, b), whole.step_b(), whole.step_a(),
             whole.point(static_cast<double>(a) + 0.5, static_cast<double>(b)));
  }
  void add_face_beside(GlobalIndex a, GlobalIndex b) {
    const LocalIndex F = face_beside(a, b);
    grid.face_id[F] = whole.face_beside(a, b);
    add_face(F, whole.axis_a, cell(a - 1, b), cell(a, b), whole.step_a(), whole.step_b(),
             whole.point(static_cast<double>(a), static_cast<double>(b) + 0.5));
  }

  void add_faces() {
    for (GlobalIndex b = owned.b_begin; b <= owned.b_end; ++b)
      for (GlobalIndex a = owned.a_begin; a < owned.a_end; ++a) add_face_below(a, b);
    if (grid.dimension == 1) return;
    for (GlobalIndex b = owned.b_begin; b < owned.b_end; ++b)
      for (GlobalIndex a = owned.a_begin; a <= owned.a_end; ++a) add_face_beside(a, b);
  }

  void add_faces_of_cells() {
    LocalIndex next = 0;
    for (GlobalIndex b = owned.b_begin; b < owned.b_end; ++b)
      for (GlobalIndex a = owned.a_begin; a < owned.a_end; ++a) {
        host.cell_faces(next++) = face_below(a, b);
        if (grid.dimension == 2) {
          host.cell_faces(next++) = face_beside(a, b);
          host.cell_faces(next++) = face_beside(a + 1, b);
        }
        host.cell_faces(next++) = face_below(a, b + 1);
      }
  }
};

}  // namespace

Grid lattice_grid(const Lattice& lattice, const core::Comm& comm) {
  Builder builder(lattice, comm);
  builder.allocate_all();
  if (builder.owned.empty()) {
    commit(builder.host, builder.grid);
    return builder.grid;
  }
  builder.add_cells();
  builder.add_vertices();
  builder.add_faces();
  builder.add_faces_of_cells();
  commit(builder.host, builder.grid);
  return builder.grid;
}

}  // namespace thixis::fv
