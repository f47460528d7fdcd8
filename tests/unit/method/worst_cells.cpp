#include "thixis/method/worst_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "thixis/method/sums.hpp"

namespace thixis::method {
namespace {

mesh::View<double*> of_cells(const std::vector<double>& values) {
  const mesh::View<double*> view("thixis::method::of_cells", values.size());
  const auto host = Kokkos::create_mirror_view(view);
  for (std::size_t K = 0; K < values.size(); ++K) host(K) = values[K];
  Kokkos::deep_copy(view, host);
  return view;
}

/// In the first cell the algebraic part is twice the others, in the second one linearization is three times the discretization, in the
/// third one, which is exact, nothing is worse: a thousandth of the mean error stands in for its own. One rank has them.
TEST(WorstCells, are_those_of_all_ranks) {
  const core::Comm comm;
  const bool here = comm.rank() == comm.size() - 1;
  const double scale = here ? 1 : 0;
  const PartsOfCells parts{of_cells({2 * scale, scale, 0}), of_cells({scale, 3 * scale, 0}),
                           of_cells({4 * scale, 3 * scale, 1e-3 * scale})};
  const GlobalIndex cells = 3 * comm.size();
  const double least = 0.01;
  const WorstCells worst = worst_cells(parts, 1e3 * least * std::sqrt(static_cast<double>(cells)), cells, comm);
  EXPECT_DOUBLE_EQ(worst.algebraic, 2);
  EXPECT_DOUBLE_EQ(worst.linearization, 3);
  const WorstCells coarse = worst_cells(parts, 1e3 * 10 * std::sqrt(static_cast<double>(cells)), cells, comm);
  EXPECT_DOUBLE_EQ(coarse.algebraic, 0.4);
  EXPECT_DOUBLE_EQ(coarse.linearization, 0.3);
}

TEST(WorstCells, are_none_where_nothing_is_left) {
  const core::Comm comm;
  const WorstCells worst = worst_cells({of_cells({1, 0}), of_cells({0, 0}), of_cells({0, 0})}, 1, 2 * comm.size(), comm);
  EXPECT_EQ(worst.algebraic, 0);
  EXPECT_EQ(worst.linearization, 0);
}

struct Powers {
  enum { first, second, count };
};

struct OfNumber {
  KOKKOS_FUNCTION void operator()(int K, Sums<Powers>& sums) const {
    sums[Powers::first] += K;
    sums[Powers::second] += K * K;
  }
};

TEST(Sums, over_cells_and_ranks_go_by_name) {
  const core::Comm comm;
  const auto sums = sum_over_cells<Powers>("thixis::method::powers", 5, OfNumber{}).over(comm);
  EXPECT_EQ(sums[Powers::first], 10 * comm.size());
  EXPECT_EQ(sums[Powers::second], 30 * comm.size());
}

}  // namespace
}  // namespace thixis::method
