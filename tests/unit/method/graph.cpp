#include "thixis/method/graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"

namespace thixis::method {
namespace {

/// A chain of nodes 0 … N-1; element e joins e, e+1 and e+2. Each rank owns a run of nodes and sees every element with one of them; node 3
/// has no unknown.
struct Chain {
  static constexpr GlobalIndex held = 3;
  const core::Comm comm;
  GlobalIndex nodes;
  algebra::MapPtr rows, columns;
  std::vector<GlobalIndex> elements;  ///< on this rank
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> unknowns;

  explicit Chain(GlobalIndex n) : nodes(n) {
    const GlobalIndex first = n * comm.rank() / comm.size(), last = n * (comm.rank() + 1) / comm.size();
    std::vector<GlobalIndex> own, ghosts;
    for (GlobalIndex v = first; v < last; ++v)
      if (v != held) own.push_back(v);
    std::set<GlobalIndex> seen;
    for (GlobalIndex e = 0; e + 2 < n; ++e)
      if (e + 2 >= first && e < last) {
        elements.push_back(e);
        for (GlobalIndex v = e; v <= e + 2; ++v)
          if ((v < first || v >= last) && v != held) seen.insert(v);
      }
    rows = algebra::map_of(own, comm);
    ghosts.assign(seen.begin(), seen.end());
    own.insert(own.end(), ghosts.begin(), ghosts.end());
    columns = algebra::map_of(own, comm);
    unknowns = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>("unknowns", elements.size(), 3);
    const auto host = Kokkos::create_mirror_view(unknowns);
    for (std::size_t k = 0; k < elements.size(); ++k)
      for (int i = 0; i < 3; ++i) host(k, i) = elements[k] + i == held ? -1 : columns->getLocalElement(elements[k] + i);
    Kokkos::deep_copy(unknowns, host);
  }
};

/// No symmetry that could hide a swapped index.
double local_matrix(GlobalIndex e, int i, int j) { return 1 + 0.1 * static_cast<double>(e) + 10 * i + 100 * j; }

std::map<std::pair<GlobalIndex, GlobalIndex>, double> expected_matrix(GlobalIndex nodes) {
  std::map<std::pair<GlobalIndex, GlobalIndex>, double> A;
  for (GlobalIndex e = 0; e + 2 < nodes; ++e)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (e + i != Chain::held && e + j != Chain::held) A[{e + i, e + j}] += local_matrix(e, i, j);
  return A;
}

}  // namespace

TEST(Graph, refuses_elements_that_are_too_wide) {
  const Chain chain(5);
  const auto graph = make_graph(chain.rows, chain.columns, chain.unknowns);
  algebra::Matrix A(graph);
  const Kokkos::View<double***, Kokkos::LayoutRight> wide("wide", 1, 70, 70);
  try {
    scatter(chain.unknowns, 0, wide, A);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_STREQ(error.what(), "An element has 70 unknowns, and the assembly of its matrix serves at most 64.");
  }
}

TEST(Graph, couples_the_unknowns_of_each_element_and_no_others_sorted) {
  const Chain chain(23);
  const auto graph = make_graph(chain.rows, chain.columns, chain.unknowns);
  const auto expected = expected_matrix(chain.nodes);
  EXPECT_EQ(static_cast<std::size_t>(graph->getGlobalNumEntries()), expected.size());
  for (LocalIndex row = 0; row < algebra::local_rows(*graph); ++row) {
    typename algebra::Graph::local_inds_host_view_type entries;
    graph->getLocalRowView(row, entries);
    for (std::size_t k = 0; k < entries.extent(0); ++k) {
      EXPECT_EQ(expected.count({chain.rows->getGlobalElement(row), chain.columns->getGlobalElement(entries(k))}), 1u);
      if (k > 0) {
        EXPECT_LT(entries(k - 1), entries(k));
      }
    }
  }
}

TEST(Scatter, adds_local_matrices_up_to_the_global_one_in_blocks_of_any_size) {
  const Chain chain(23);
  const auto expected = expected_matrix(chain.nodes);
  for (const int block : {1, 5, 1000}) {
    algebra::Matrix A(make_graph(chain.rows, chain.columns, chain.unknowns));
    A.fillComplete();
    const int count = static_cast<int>(chain.elements.size());
    for (int first = 0; first < count; first += block) {
      Kokkos::View<double***, Kokkos::LayoutRight> local("local", std::min(block, count - first), 3, 3);
      const auto host = Kokkos::create_mirror_view(local);
      for (int k = 0; k < local.extent_int(0); ++k)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) host(k, i, j) = local_matrix(chain.elements[first + k], i, j);
      Kokkos::deep_copy(local, host);
      scatter(chain.unknowns, first, local, A);
    }
    const auto matrix = A.getLocalMatrixHost();
    for (LocalIndex row = 0; row < matrix.numRows(); ++row)
      for (auto k = matrix.graph.row_map(row); k < matrix.graph.row_map(row + 1); ++k)
        EXPECT_DOUBLE_EQ(matrix.values(k),
                         expected.at({chain.rows->getGlobalElement(row), chain.columns->getGlobalElement(matrix.graph.entries(k))}));
  }
}

TEST(Scatter, adds_local_vectors_up_to_the_global_one) {
  const Chain chain(23);
  algebra::Vector b(chain.rows);
  Kokkos::View<double**, Kokkos::LayoutRight> local("local", chain.elements.size(), 3);
  const auto host = Kokkos::create_mirror_view(local);
  for (std::size_t k = 0; k < chain.elements.size(); ++k)
    for (int i = 0; i < 3; ++i) host(k, i) = local_matrix(chain.elements[k], i, 0);
  Kokkos::deep_copy(local, host);
  scatter(chain.unknowns, 0, local, b);
  const auto values = algebra::host_view(std::as_const(b));
  for (std::size_t row = 0; row < values.extent(0); ++row) {
    const GlobalIndex v = chain.rows->getGlobalElement(static_cast<LocalIndex>(row));
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      if (v - i >= 0 && v - i + 2 < chain.nodes) sum += local_matrix(v - i, i, 0);
    EXPECT_DOUBLE_EQ(values(row), sum) << v;
  }
}

}  // namespace thixis::method
