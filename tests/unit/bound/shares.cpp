#include "thixis/bound/shares.hpp"

#include <gtest/gtest.h>

namespace thixis::bound {

TEST(Shares, the_stiffer_membrane_gives_way_less) {
  const Shares of = shares(3, 1);
  EXPECT_GT(of.of_mean[0], of.of_mean[1]);
  EXPECT_LT(of.of_way[0], of.of_way[1]);
  for (const auto& both : {of.of_mean, of.of_way}) EXPECT_DOUBLE_EQ(both[0] + both[1], 1);
}

/// u_1 and u_2 meet where both come to: at the mean.
TEST(Shares, a_gap_closes_at_the_mean) {
  const double u1 = 0.7, u2 = -0.4;
  for (const auto& [upper, lower] :
       {std::pair(1.0, 1.0), std::pair(2.0, 5.0), std::pair(1e8, 1.0), std::pair(0.0, 2.0), std::pair(0.0, 0.0)}) {
    const Shares of = shares(upper, lower);
    const double mean = of.of_mean[0] * u1 + of.of_mean[1] * u2;
    EXPECT_NEAR(u1 - of.of_way[0] * (u1 - u2), mean, 1e-15);
    EXPECT_NEAR(u2 + of.of_way[1] * (u1 - u2), mean, 1e-15);
  }
}

/// mu_1 v_1² + mu_2 v_2² is least among all ways with v_1 + v_2 = 1.
TEST(Shares, the_way_costs_least) {
  const double mu1 = 2, mu2 = 5;
  const auto energy = [&](double first) { return mu1 * first * first + mu2 * (1 - first) * (1 - first); };
  const double first = shares(mu1, mu2).of_way[0];
  for (const double other : {first - 0.01, first + 0.01}) EXPECT_GT(energy(other), energy(first));
}

TEST(Shares, follow_the_tensions_from_place_to_place) {
  const auto mu1 = scene::expression("mu1", "1 + x", {0, 0}, {}), mu2 = scene::expression("mu2", "2 - y", {0, 0}, {});
  const auto ways = ways_of_upper({mu1, mu2}, {0, 1, 0.5}, {0, 1, 1});
  ASSERT_EQ(ways.size(), 3u);
  EXPECT_DOUBLE_EQ(ways[0], 2.0 / 3);
  EXPECT_DOUBLE_EQ(ways[1], 1.0 / 3);
  EXPECT_DOUBLE_EQ(ways[2], 0.4);
}

}  // namespace thixis::bound
