#include "thixis/method/graph.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/core/error.hpp"

namespace thixis::method {
namespace {

using LocalGraph = algebra::Graph::local_graph_device_type;
using Execution = algebra::Graph::execution_space;
constexpr bool concurrent = !std::is_same_v<Execution, Kokkos::Serial>;

template <class T>
KOKKOS_INLINE_FUNCTION void add(T& target, double value) {
  if constexpr (concurrent) Kokkos::atomic_add(&target, value);
  else target += value;
}

constexpr int most_unknowns = 64;  ///< of an element: 2 x 27 for two fields of the widest one

/// Rows and the columns of an element are both sorted: one walk along the row finds them all.
struct ScatterMatrix {
  ElementUnknowns elements;
  Kokkos::View<const double***, Kokkos::LayoutRight> local;
  algebra::Matrix::local_matrix_device_type A;
  LocalIndex first;

  KOKKOS_FUNCTION void operator()(int e) const {
    int order[most_unknowns];
    LocalIndex column[most_unknowns];
    const int count = sorted(e, order, column);
    for (int i = 0; i < local.extent_int(1); ++i) {
      const LocalIndex row = elements(first + e, i);
      if (row < 0 || row >= A.numRows()) continue;
      std::size_t at = A.graph.row_map(row);
      for (int k = 0; k < count; ++k) {
        while (A.graph.entries(at) < column[k]) ++at;
        add(A.values(at), local(e, i, order[k]));
      }
    }
  }

 private:
  /// The unknowns of the element by ascending column.
  KOKKOS_FUNCTION int sorted(int e, int* order, LocalIndex* column) const {
    int count = 0;
    for (int j = 0; j < local.extent_int(2); ++j) {
      const LocalIndex c = elements(first + e, j);
      if (c < 0) continue;
      int k = count++;
      for (; k > 0 && column[k - 1] > c; --k) {
        column[k] = column[k - 1];
        order[k] = order[k - 1];
      }
      column[k] = c;
      order[k] = j;
    }
    return count;
  }
};

template <class Values>
struct ScatterVector {
  ElementUnknowns elements;
  Kokkos::View<const double**, Kokkos::LayoutRight> local;
  Values b;
  LocalIndex first;

  KOKKOS_FUNCTION void operator()(int e) const {
    for (int i = 0; i < local.extent_int(1); ++i) {
      const LocalIndex row = elements(first + e, i);
      if (row >= 0 && row < b.extent_int(0)) add(b(row, 0), local(e, i));
    }
  }
};

}  // namespace

algebra::GraphPtr make_graph(const algebra::MapPtr& rows, const algebra::MapPtr& columns, const ElementUnknowns& elements_device) {
  const auto elements = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), elements_device);
  const LocalIndex row_count = algebra::local_size(*rows);
  const int count = elements.extent_int(0), width = elements.extent_int(1);

  // elements of each row
  std::vector<LocalIndex> offset(row_count + 1, 0);
  for (int e = 0; e < count; ++e)
    for (int i = 0; i < width; ++i)
      if (const LocalIndex row = elements(e, i); row >= 0 && row < row_count) ++offset[row + 1];
  for (LocalIndex row = 0; row < row_count; ++row) offset[row + 1] += offset[row];
  std::vector<LocalIndex> of_row(offset[row_count]), next(offset.begin(), offset.end() - 1);
  for (int e = 0; e < count; ++e)
    for (int i = 0; i < width; ++i)
      if (const LocalIndex row = elements(e, i); row >= 0 && row < row_count) of_row[next[row]++] = e;

  // their unknowns, sorted, without repetition
  std::vector<LocalIndex> entries, buffer;
  entries.reserve(static_cast<std::size_t>(row_count) * (width + width / 2 + 3));
  typename LocalGraph::row_map_type::non_const_type row_map("thixis::method::row_map", row_count + 1);
  const auto row_map_host = Kokkos::create_mirror_view(row_map);
  row_map_host(0) = 0;
  for (LocalIndex row = 0; row < row_count; ++row) {
    buffer.clear();
    for (LocalIndex k = offset[row]; k < offset[row + 1]; ++k)
      for (int i = 0; i < width; ++i)
        if (const LocalIndex column = elements(of_row[k], i); column >= 0) buffer.push_back(column);
    std::sort(buffer.begin(), buffer.end());
    buffer.erase(std::unique(buffer.begin(), buffer.end()), buffer.end());
    entries.insert(entries.end(), buffer.begin(), buffer.end());
    row_map_host(row + 1) = entries.size();
  }
  Kokkos::deep_copy(row_map, row_map_host);
  typename LocalGraph::entries_type::non_const_type columns_view("thixis::method::columns", entries.size());
  Kokkos::deep_copy(columns_view, Kokkos::View<const LocalIndex*, Kokkos::HostSpace>(entries.data(), entries.size()));
  return algebra::make_graph(rows, columns, row_map, columns_view);
}

void scatter(const ElementUnknowns& elements, LocalIndex first, const Kokkos::View<const double***, Kokkos::LayoutRight>& local,
             algebra::Matrix& A) {
  if (local.extent_int(2) > most_unknowns)
    throw core::Error(core::ExitCode::internal, "An element has " + std::to_string(local.extent(2)) +
                                                    " unknowns, and the assembly of its matrix serves at most " +
                                                    std::to_string(most_unknowns) + ".");
  Kokkos::parallel_for("thixis::method::scatter_matrix", Kokkos::RangePolicy<Execution>(0, local.extent_int(0)),
                       ScatterMatrix{elements, local, A.getLocalMatrixDevice(), first});
}

void scatter(const ElementUnknowns& elements, LocalIndex first, const Kokkos::View<const double**, Kokkos::LayoutRight>& local,
             algebra::Vector& b) {
  const auto values = b.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for("thixis::method::scatter_vector", Kokkos::RangePolicy<Execution>(0, local.extent_int(0)),
                       ScatterVector<decltype(values)>{elements, local, values, first});
}

}  // namespace thixis::method
