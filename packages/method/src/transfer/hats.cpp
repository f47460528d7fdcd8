#include "transfer/hats.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "space/columns.hpp"
#include "thixis/algebra/structure.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/method/continuous_nodes.hpp"
#include "transfer/terms.hpp"

namespace thixis::method {
namespace {

using OfVertices = std::array<GlobalIndex, 3>;

const reference::CellBasis& linear_functions() {
  static const reference::CellBasis basis(1, reference::Family::equispaced);
  return basis;
}

std::vector<LocalIndex> to_host(const View<const LocalIndex*>& view) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
  return {host.data(), host.data() + host.extent(0)};
}

/// The functions that take part on the finer side.
struct Finer {
  const mesh::Mesh& mesh;
  std::vector<LocalIndex> cells;  ///< patch cells
  algebra::MapPtr rows;
  Terms terms;
  FunctionalsOfChildren W;
};

/// Of cells whose owner may be any rank, by their ids.
std::vector<OfVertices> fetch(const Hats& coarse, const std::vector<GlobalIndex>& cells) {
  const mesh::Mesh& mesh = coarse.mesh();
  std::vector<GlobalIndex> once = cells;
  std::sort(once.begin(), once.end());
  once.erase(std::unique(once.begin(), once.end()), once.end());
  const auto own = algebra::map_of({mesh.cell_id.begin(), mesh.cell_id.begin() + mesh.owned_cells}, mesh.comm);
  const auto wanted = algebra::map_of(once, mesh.comm);
  algebra::MultiVector known(own, 3), fetched(wanted, 3);
  {
    const std::vector<OfVertices> ids = coarse.ids();
    const auto out = known.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int i = 0; i < 3; ++i) out(K, i) = static_cast<double>(ids[K][i]);
  }
  fetched.doImport(known, algebra::Import(own, wanted), Tpetra::INSERT);
  const auto in = std::as_const(fetched).getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<OfVertices> ids;
  ids.reserve(cells.size());
  for (const GlobalIndex cell : cells) {
    const auto at = std::lower_bound(once.begin(), once.end(), cell) - once.begin();
    ids.push_back({static_cast<GlobalIndex>(in(at, 0)), static_cast<GlobalIndex>(in(at, 1)), static_cast<GlobalIndex>(in(at, 2))});
  }
  return ids;
}

/// The hats of the parent of each patch cell, or of the cell itself on the same mesh.
std::vector<OfVertices> hats_of_parents(const Hats& coarse, const Finer& fine) {
  if (&fine.mesh == &coarse.mesh()) return coarse.ids();
  std::vector<LocalIndex> position(coarse.mesh().cells, -1);
  const std::vector<LocalIndex> coarse_cells = to_host(coarse.cells());
  for (std::size_t k = 0; k < coarse_cells.size(); ++k) position[coarse_cells[k]] = static_cast<LocalIndex>(k);
  const auto at = [&](LocalIndex K) { return fine.mesh.cell_parent[K] < 0 ? -1 : position[fine.mesh.cell_parent[K]]; };
  if (coarse.mesh().comm.all(std::all_of(fine.cells.begin(), fine.cells.end(), [&](LocalIndex K) { return at(K) >= 0; }))) {
    const std::vector<OfVertices> ids = coarse.ids();
    std::vector<OfVertices> of_parents;
    of_parents.reserve(fine.cells.size());
    for (const LocalIndex K : fine.cells) of_parents.push_back(ids[at(K)]);
    return of_parents;
  }
  std::vector<GlobalIndex> parents;
  parents.reserve(fine.cells.size());
  for (const LocalIndex K : fine.cells) parents.push_back(fine.mesh.cell_parent_id[K]);
  return fetch(coarse, parents);
}

/// A row of P, sorted by hat.
class Row {
 public:
  void clear() { entries_.clear(); }
  void add(GlobalIndex hat, double weight) {
    if (hat < 0 || std::abs(weight) < negligible) return;
    auto at = entries_.begin();
    while (at != entries_.end() && at->first < hat) ++at;
    if (at != entries_.end() && at->first == hat) at->second += weight;
    else entries_.insert(at, {hat, weight});
  }
  const std::vector<std::pair<GlobalIndex, double>>& entries() const { return entries_; }

 private:
  static constexpr double negligible = 1e-13;  ///< rounding of a functional that is 0
  std::vector<std::pair<GlobalIndex, double>> entries_;
};

/// The rows of P, in ids of hats.
struct Rows {
  std::vector<std::size_t> begin = {0};
  std::vector<GlobalIndex> hat;
  std::vector<double> weight;
};

Rows rows_of(const Hats& coarse, const Finer& fine) {
  const bool same_mesh = &fine.mesh == &coarse.mesh();
  const std::vector<OfVertices> hats = hats_of_parents(coarse, fine);
  const auto W = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), fine.W);
  const Terms& terms = fine.terms;
  const std::size_t count = terms.begin.size() - 1;
  Rows rows;
  rows.begin.reserve(count + 1);
  rows.hat.reserve(2 * count);
  rows.weight.reserve(2 * count);
  Row row;
  for (std::size_t r = 0; r < count; ++r) {
    row.clear();
    const LocalIndex first = terms.begin[r], last = terms.begin[r + 1];
    for (LocalIndex t = first; t < last; ++t) {
      const LocalIndex k = terms.cell[t];
      const int place = terms.place[t], q = place < 0 ? -1 - place : place, shape = same_mesh ? 0 : fine.mesh.cell_shape[fine.cells[k]];
      const double sign = place < 0 ? -1 : 1;
      for (int j = 0; j < 3; ++j) row.add(hats[k][j], sign * W(shape, q, j) / (last - first));
    }
    for (const auto& [hat, value] : row.entries()) {
      rows.hat.push_back(hat);
      rows.weight.push_back(value);
    }
    rows.begin.push_back(rows.hat.size());
  }
  return rows;
}

/// Ids as columns: those of this rank, in their order, then the others that occur, sorted, and so by rank.
class Columns {
 public:
  Columns(const algebra::Map& own, const std::vector<GlobalIndex>& ids)
      : count_(algebra::local_size(own)), first_(count_ > 0 ? own.getGlobalElement(0) : 0) {
    for (const GlobalIndex id : ids)
      if (!is_own(id)) others_.push_back(id);
    std::sort(others_.begin(), others_.end());
    others_.erase(std::unique(others_.begin(), others_.end()), others_.end());
  }
  LocalIndex operator()(GlobalIndex id) const {
    if (is_own(id)) return static_cast<LocalIndex>(id - first_);
    return count_ + static_cast<LocalIndex>(std::lower_bound(others_.begin(), others_.end(), id) - others_.begin());
  }
  std::vector<GlobalIndex> ids() const {
    std::vector<GlobalIndex> all(count_);
    std::iota(all.begin(), all.end(), first_);
    all.insert(all.end(), others_.begin(), others_.end());
    return all;
  }

 private:
  bool is_own(GlobalIndex id) const { return id >= first_ && id < first_ + count_; }
  LocalIndex count_;
  GlobalIndex first_;
  std::vector<GlobalIndex> others_;
};

template <class View, class T>
View to_device(const std::string& label, const std::vector<T>& values) {
  const View view(label, values.size());
  Kokkos::deep_copy(view, Kokkos::View<const T*, Kokkos::HostSpace>(values.data(), values.size()));
  return view;
}

Teuchos::RCP<const algebra::Matrix> in_finer(const Hats& coarse, const Finer& fine) {
  Rows rows = rows_of(coarse, fine);
  const Columns columns(*coarse.map(), rows.hat);
  std::vector<LocalIndex> entries(rows.hat.size());
  std::vector<std::pair<LocalIndex, double>> row;
  for (std::size_t r = 0; r + 1 < rows.begin.size(); ++r) {
    row.clear();
    for (std::size_t t = rows.begin[r]; t < rows.begin[r + 1]; ++t) row.emplace_back(columns(rows.hat[t]), rows.weight[t]);
    std::sort(row.begin(), row.end());
    for (std::size_t k = 0; k < row.size(); ++k) std::tie(entries[rows.begin[r] + k], rows.weight[rows.begin[r] + k]) = row[k];
  }
  const core::Comm& comm = coarse.mesh().comm;
  return algebra::make_matrix(fine.rows, comm.size() == 1 ? coarse.map() : algebra::map_of(columns.ids(), comm), coarse.map(),
                              to_device<algebra::RowMap>("thixis::method::hats_rows", rows.begin),
                              to_device<algebra::Entries>("thixis::method::hats_columns", entries),
                              to_device<algebra::Values>("thixis::method::hats_weights", rows.weight));
}

}  // namespace

Hats::Hats(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet) : mesh_(mesh), cells_(patch_cells(mesh)) {
  const ContinuousNodes nodes = continuous_nodes(mesh, cells_, linear_functions(), linear_functions().points(), dirichlet);
  numbering_ = number(nodes.entries, mesh.comm);
  elements_ = columns_of(nodes.of_cells, numbering_.column_of_entry);
}

std::vector<OfVertices> Hats::ids() const {
  const auto columns = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), elements_);
  std::vector<OfVertices> ids(columns.extent(0));
  for (std::size_t k = 0; k < ids.size(); ++k)
    for (int i = 0; i < 3; ++i) ids[k][i] = columns(k, i) < 0 ? -1 : numbering_.columns->getGlobalElement(columns(k, i));
  return ids;
}

Teuchos::RCP<const algebra::Matrix> in_finer(const Hats& coarse, const Hats& fine) {
  const int n = linear_functions().size();
  return in_finer(coarse, Finer{fine.mesh(), to_host(fine.cells()), fine.map(),
                                terms_of(fine.elements(), algebra::local_size(*fine.map()), n, [](LocalIndex, int) { return false; }),
                                functionals_of_children(linear_functions(), linear_functions(), {})});
}

Teuchos::RCP<const algebra::Matrix> in_finer(const Hats& coarse, const Space& fine) {
  THIXIS_ASSERT_EQ(fine.components(), 1, "hats are scalar functions");
  const int n = fine.basis().size();
  const auto backwards = [&](LocalIndex k, int i) { return fine.layout().backwards(fine, k, i - n); };
  return in_finer(coarse, Finer{fine.mesh(), to_host(fine.cells()), fine.map(),
                                terms_of(fine.elements(), algebra::local_size(*fine.map()), n, backwards),
                                functionals_of_children(linear_functions(), fine.basis(), fine.layout().trace_functionals())});
}

}  // namespace thixis::method
