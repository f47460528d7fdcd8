/// Sums over cells by name.
#include "estimate/sums.hpp"

#include <gtest/gtest.h>

namespace thixis::bound {
namespace {

struct OfTest {
  enum { cells, places, squares, count };
};

struct Terms {
  KOKKOS_FUNCTION void operator()(int K, Sums<OfTest>& sum) const {
    sum[OfTest::cells] += 1;
    sum[OfTest::places] += K;
    sum[OfTest::squares] += static_cast<double>(K) * K;
  }
};

TEST(SumsOverCells, are_those_of_all_cells_of_all_ranks) {
  const core::Comm comm;
  const int n = 100 + comm.rank(), ranks = comm.size();
  const auto here = sum_over_cells<OfTest>("sums", n, Terms{});
  EXPECT_EQ(here[OfTest::places], n * (n - 1) / 2);
  EXPECT_EQ(here[OfTest::squares], (n - 1) * n * (2 * n - 1) / 6);
  const auto all = here.over(comm);
  EXPECT_EQ(all[OfTest::cells], 100 * ranks + ranks * (ranks - 1) / 2);
  EXPECT_EQ(all[OfTest::places], comm.sum(here[OfTest::places]));
}

TEST(SumsOverCells, are_zero_where_there_is_no_cell) {
  const auto none = sum_over_cells<OfTest>("sums", 0, Terms{});
  for (int name = 0; name < OfTest::count; ++name) EXPECT_EQ(none[name], 0);
}

TEST(SumsOverCells, add_up_by_name) {
  auto sum = sum_over_cells<OfTest>("sums", 4, Terms{});
  sum += sum;
  EXPECT_EQ(sum[OfTest::cells], 8);
  EXPECT_EQ(sum[OfTest::places], 12);
}

}  // namespace
}  // namespace thixis::bound
