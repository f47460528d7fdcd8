#include "problem/pattern.hpp"

#include "step/vectors.hpp"
#include "thixis/fv/raviart_thomas.hpp"

namespace thixis::flow {
namespace {

using LocalGraph = algebra::Graph::local_graph_device_type;

/// A cell and its neighbours, rising.
struct Group {
  LocalIndex cell[fv::RaviartThomas::most_faces + 1];
  int count = 0;

  KOKKOS_INLINE_FUNCTION void insert(LocalIndex K) {
    int i = count++;
    for (; i > 0 && cell[i - 1] > K; --i) cell[i] = cell[i - 1];
    cell[i] = K;
  }
  KOKKOS_INLINE_FUNCTION LocalIndex place(LocalIndex K) const {
    LocalIndex i = 0;
    while (cell[i] != K) ++i;
    return i;
  }
};

struct Neighbours {
  fv::View<LocalIndex*> begin, faces;
  fv::View<LocalIndex* [2]> cells;

  explicit Neighbours(const fv::Grid& grid) : begin(grid.cell_face_begin), faces(grid.cell_faces), cells(grid.face_cells) {}
  /// Across the f-th entry of Grid::cell_faces, which is a face of K; -1: none.
  KOKKOS_INLINE_FUNCTION LocalIndex across(LocalIndex K, LocalIndex f) const {
    return cells(faces(f), 0) == K ? cells(faces(f), 1) : cells(faces(f), 0);
  }
  KOKKOS_INLINE_FUNCTION Group group(LocalIndex K) const {
    Group group;
    group.insert(K);
    for (LocalIndex f = begin(K); f < begin(K + 1); ++f)
      if (across(K, f) >= 0) group.insert(across(K, f));
    return group;
  }
};

struct CountEntries {
  Neighbours neighbours;
  LocalIndex cells;
  fv::View<LocalIndex*> row_begin;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K, LocalIndex& sum, bool final) const {
    if (final) row_begin(K) = sum;
    if (K < cells) sum += unknowns_per_cell * (1 + components * neighbours.group(K).count);
  }
};

struct FillPattern {
  Neighbours neighbours;
  fv::View<LocalIndex*> row_begin;
  fv::View<LocalIndex*> own, place;                  ///< out, overwritten
  LocalGraph::row_map_type::non_const_type rows;     ///< out, overwritten but for the first one, which is 0
  LocalGraph::entries_type::non_const_type columns;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const Group group = neighbours.group(K);
    own(K) = group.place(K);
    for (LocalIndex f = neighbours.begin(K); f < neighbours.begin(K + 1); ++f) {
      const LocalIndex L = neighbours.across(K, f);
      place(f) = L < 0 ? -1 : group.place(L);
    }
    LocalIndex entry = row_begin(K), row = unknowns_per_cell * K;
    add_cell(K, entry);
    rows(++row) = entry;
    for (int c = 0; c < components; ++c) {
      for (int i = 0; i < group.count; ++i) add_cell(group.cell[i], entry);
      rows(++row) = entry;
    }
  }
  KOKKOS_INLINE_FUNCTION void add_cell(LocalIndex K, LocalIndex& entry) const {
    for (int u = 0; u < unknowns_per_cell; ++u) columns(entry++) = unknowns_per_cell * K + u;
  }
};

}  // namespace

Pattern::Pattern(const TwoPhaseOperator& flow)
    : row_begin("thixis::flow::row_begin", flow.grid().owned_cells + 1),
      own("thixis::flow::own", flow.grid().owned_cells),
      place("thixis::flow::place", flow.grid().cell_faces.extent(0)) {
  const LocalIndex cells = flow.grid().owned_cells;
  const Neighbours neighbours(flow.grid());
  LocalIndex entries = 0;
  Kokkos::parallel_scan("thixis::flow::row_begin", Cells(0, cells + 1), CountEntries{neighbours, cells, row_begin}, entries);
  FillPattern kernel{neighbours};
  kernel.row_begin = row_begin;
  kernel.own = own;
  kernel.place = place;
  kernel.rows = LocalGraph::row_map_type::non_const_type("thixis::flow::row_map", unknowns_per_cell * cells + 1);
  kernel.columns = LocalGraph::entries_type::non_const_type("thixis::flow::entries", entries);
  Kokkos::parallel_for("thixis::flow::pattern", Cells(0, cells), kernel);
  matrix = Teuchos::rcp(new algebra::Matrix(algebra::make_graph(flow.map(), flow.column_map(), kernel.rows, kernel.columns)));
  matrix->fillComplete();
}

}  // namespace thixis::flow
