#include "transfer/terms.hpp"

#include "thixis/mesh/ancestry.hpp"

namespace thixis::method {

FunctionalsOfChildren functionals_of_children(const reference::CellBasis& parent, const reference::CellBasis& child,
                                              const std::vector<double>& traces) {
  const int n = child.size(), m = parent.size(), more = static_cast<int>(traces.size()) / n;
  const auto& shapes = mesh::child_shapes();
  const FunctionalsOfChildren W("thixis::method::to_children", shapes.size(), n + more, m);
  const auto out = Kokkos::create_mirror_view(W);
  std::vector<double> at(2 * n);
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    for (int l = 0; l < n; ++l) {
      const double xi = child.points()[2 * l], eta = child.points()[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
      for (int d = 0; d < 2; ++d)
        at[2 * l + d] = lambda[0] * shapes[s][0][d + 1] + lambda[1] * shapes[s][1][d + 1] + lambda[2] * shapes[s][2][d + 1];
    }
    const auto table = parent.tabulate(n, at.data());
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < m; ++j)
        for (int l = 0; l < n; ++l) out(s, i, j) += child.from_values()[i * n + l] * table.value[l * m + j];
    for (int q = 0; q < more; ++q)
      for (int j = 0; j < m; ++j)
        for (int l = 0; l < n; ++l) out(s, n + q, j) += traces[q * n + l] * out(s, l, j);
  }
  Kokkos::deep_copy(W, out);
  return W;
}

Terms terms_of(const ElementUnknowns& elements, LocalIndex rows, int of_cell, const std::function<bool(LocalIndex, int)>& backwards) {
  const auto columns = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), elements);
  struct OfRow {
    LocalIndex cell[2] = {-1, -1};
    int place[2] = {0, 0};
  };
  std::vector<OfRow> of_rows(rows);
  for (LocalIndex k = 0; k < columns.extent_int(0); ++k)
    for (int i = 0; i < columns.extent_int(1); ++i) {
      const LocalIndex row = columns(k, i);
      if (row < 0 || row >= rows) continue;
      const int term = i >= of_cell && of_rows[row].cell[0] >= 0 ? 1 : 0;
      of_rows[row].cell[term] = k;
      of_rows[row].place[term] = i >= of_cell && backwards(k, i) ? -1 - i : i;
    }
  Terms terms;
  terms.begin.reserve(rows + 1);
  terms.cell.reserve(rows);
  terms.place.reserve(rows);
  terms.begin.push_back(0);
  for (const OfRow& of_row : of_rows) {
    for (int term = 0; term < 2 && of_row.cell[term] >= 0; ++term) {
      terms.cell.push_back(of_row.cell[term]);
      terms.place.push_back(of_row.place[term]);
    }
    terms.begin.push_back(static_cast<LocalIndex>(terms.cell.size()));
  }
  return terms;
}

}  // namespace thixis::method
