#include <gtest/gtest.h>

#include <set>

#include "grids.hpp"
#include "lattice.hpp"

namespace thixis::fv {
namespace {

Lattice of(const mesh::MeshParams& params) { return lattice(params); }

}  // namespace

TEST(split, of_long_grids_are_strips) {
  for (const auto& params : {tensor_params(1000, 40), tensor_params(40, 1000)})
    for (const int ranks : {1, 2, 3, 4, 16, 25}) {
      const Split parts = split(of(params), ranks);
      EXPECT_EQ(parts.parts_a, 1);
      EXPECT_EQ(parts.parts_b, ranks);
    }
  EXPECT_EQ(split(of(interval_params(100)), 6).parts_b, 6);
}

TEST(split, of_squares_are_nearly_squares) {
  const Lattice square = of(tensor_params(120, 120));
  EXPECT_EQ(split(square, 4).parts_a, 2);
  EXPECT_EQ(split(square, 36).parts_a, 6);
  const Split parts = split(square, 12);
  EXPECT_EQ(std::min(parts.parts_a, parts.parts_b), 3);
}

TEST(split, leaves_no_rank_idle_that_can_work) {
  const Split parts = split(of(tensor_params(4, 3)), 12);
  EXPECT_EQ(parts.parts_a, 3);
  EXPECT_EQ(parts.parts_b, 4);
}

TEST(split, parts_follow_each_other_and_know_their_entities) {
  for (const GlobalIndex n : {1LL, 2LL, 7LL, 100LL, 3000000000LL})
    for (const int parts : {1, 2, 3, 7, 64}) {
      EXPECT_EQ(begin(n, parts, 0), 0);
      EXPECT_EQ(begin(n, parts, parts), n);
      for (int k = 0; k < parts; ++k) {
        const GlobalIndex from = begin(n, parts, k), to = begin(n, parts, k + 1);
        EXPECT_TRUE(to - from == n / parts || to - from == n / parts + 1);
        if (from == to) continue;
        EXPECT_EQ(part_of(n, parts, from), k);
        EXPECT_EQ(part_of(n, parts, to - 1), k);
      }
    }
}

}  // namespace thixis::fv
