#include "thixis/complementarity/kkt.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "dense_problem.hpp"
#include "thixis/core/error.hpp"
#include "views.hpp"

namespace thixis::complementarity::test {
namespace {

constexpr int n = 24;

/// The two strings' solution; the multipliers of the bodies come from finite differences of u_1 and u_2 alone.
struct Solution {
  std::vector<Values> u{Values(n + 1), Values(n + 1)};
  Values lambda = Values(n + 1, 0.0);

  Solution() {
    for (int i = 1; i < n; ++i)
      for (int f = 0; f < 3; ++f) (f < 2 ? u[f] : lambda)[i] = two_strings_solution(n, f, i - 1);
    const double w = 0.5, z = 0.25;
    for (const int i : {0, n}) u[0][i] = (w + 3 * z) / 5, u[1][i] = (w - 2 * z) / 5;
  }

  KktData data() const {
    const auto map = Teuchos::rcp(new algebra::Map(n - 1, 0, Tpetra::getDefaultComm()));
    const auto vector = [&](const std::function<double(int)>& value) {
      const auto v = Teuchos::rcp(new algebra::Vector(map));
      for (int l = 0; l < algebra::local_size(*map); ++l) v->replaceLocalValue(l, value(static_cast<int>(map->getGlobalElement(l)) + 1));
      return v;
    };
    const auto bend = [&](int body, int i) { return -(u[body][i - 1] - 2 * u[body][i] + u[body][i + 1]) * n * n; };
    KktData data;
    data.gap = vector([&](int i) { return u[0][i] - u[1][i]; });
    data.equilibrium = {vector([&](int i) { return 2 * bend(0, i) + 2.0 * (-2 + 24) / 5; }),
                        vector([&](int i) { return -3.0 * (-2 - 16) / 5 - 3 * bend(1, i); })};
    data.claimed = vector([&](int i) { return lambda[i]; });
    data.gap_scale = 0.25;
    data.multiplier_scale = 9.6;
    return data;
  }
};

constexpr double tolerance = 1e-9;

TEST(Kkt, accepts_the_solution) {
  const Kkt kkt = verify(Solution().data());
  EXPECT_TRUE(kkt.holds(tolerance)) << kkt.sentence(tolerance);
  EXPECT_NE(kkt.sentence(tolerance).find("hold"), std::string::npos);
}

TEST(Kkt, rejects_a_perturbed_displacement_at_any_point) {
  for (int i = 1; i < n; ++i) {
    Solution wrong;
    wrong.u[0][i] -= 1e-5;
    EXPECT_FALSE(verify(wrong.data()).holds(tolerance)) << i;
    wrong.u[0][i] += 2e-5;
    EXPECT_FALSE(verify(wrong.data()).holds(tolerance)) << i;
  }
}

TEST(Kkt, rejects_a_displacement_that_both_bodies_share) {
  Solution wrong;  // gap and multiplier stay complementary, but the bodies push with different forces
  wrong.u[0][5] += 1e-5;
  wrong.u[1][5] += 1e-5;
  const Kkt kkt = verify(wrong.data());
  EXPECT_LT(kkt.infeasible, tolerance);
  EXPECT_GT(kkt.equilibrium, tolerance);
}

TEST(Kkt, rejects_overlap) {
  Solution wrong;
  wrong.u[0][n / 2] -= 1e-5;
  EXPECT_NEAR(verify(wrong.data()).infeasible, 1e-5 / 0.25, 1e-12);
}

TEST(Kkt, rejects_a_multiplier_claimed_wrongly) {
  Solution wrong;
  wrong.lambda[n / 2] *= 1 + 1e-6;
  const Kkt kkt = verify(wrong.data());
  EXPECT_FALSE(kkt.holds(tolerance));
  EXPECT_GT(kkt.equilibrium, 1e-7);
  EXPECT_LT(kkt.negative, tolerance);
}

TEST(Kkt, rejects_a_multiplier_of_the_wrong_sign_claimed_or_in_equilibrium) {
  Solution claimed;
  for (double& lambda : claimed.lambda) lambda = -lambda;
  EXPECT_GT(verify(claimed.data()).negative, 0.9);
  EXPECT_GT(verify(claimed.data()).equilibrium, 0.9);

  KktData pulled = Solution().data();  // every multiplier agrees, but the bodies pull each other
  const auto minus = Teuchos::rcp(new algebra::Vector(*pulled.claimed, Teuchos::Copy));
  minus->scale(-1);
  pulled.claimed = minus;
  pulled.equilibrium = {minus, minus};
  const Kkt kkt = verify(pulled);
  EXPECT_GT(kkt.negative, 0.9);
  EXPECT_EQ(kkt.equilibrium, 0);
}

TEST(Kkt, rejects_a_multiplier_that_balances_one_body_only) {
  KktData data = Solution().data();
  const auto other = Teuchos::rcp(new algebra::Vector(*data.equilibrium[1], Teuchos::Copy));
  other->scale(1.001);
  data.equilibrium[1] = other;
  const Kkt kkt = verify(data);
  EXPECT_FALSE(kkt.holds(tolerance));
  EXPECT_LT(kkt.negative, tolerance);
  EXPECT_LT(kkt.complementary, tolerance);
}

TEST(Kkt, rejects_force_across_an_open_gap) {
  Solution wrong;
  wrong.lambda[2] = 1e-3;
  EXPECT_NEAR(verify(wrong.data()).complementary, 1e-3 / 9.6, 1e-9);
}

TEST(Kkt, rejects_equations_without_contact_points_that_do_not_balance) {
  KktData data = Solution().data();
  data.unbalanced = 1e-3;
  EXPECT_NEAR(verify(data).equilibrium, 1e-3, 1e-9);
}

TEST(Kkt, rejects_numbers_that_are_not_finite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
    Solution gap, lambda;
    gap.u[0][3] = bad;
    lambda.lambda[3] = bad;
    EXPECT_FALSE(verify(gap.data()).holds(1));
    EXPECT_FALSE(verify(lambda.data()).holds(1));
    KktData data = Solution().data();
    data.unbalanced = bad;
    EXPECT_FALSE(verify(data).holds(1));
  }
}

TEST(Kkt, does_not_judge_the_gap_between_the_points_but_reports_it) {
  KktData data = Solution().data();
  data.between_nodes = 1e-3;
  const Kkt kkt = verify(data);
  EXPECT_TRUE(kkt.holds(tolerance));
  EXPECT_DOUBLE_EQ(kkt.between_nodes, 4e-3);
  EXPECT_NE(kkt.sentence(tolerance).find("4.0e-03"), std::string::npos);
}

TEST(Kkt, is_relative_to_the_scales) {
  KktData data = Solution().data();
  const Kkt kkt = verify(data);
  const auto stretched = Teuchos::rcp(new algebra::Vector(*data.gap, Teuchos::Copy));
  stretched->scale(1000);
  data.gap = stretched;
  data.gap_scale *= 1000;
  EXPECT_NEAR(verify(data).complementary, kkt.complementary, 1e-14);
}

TEST(Kkt, names_what_is_wrong) {
  Solution wrong;
  for (double& lambda : wrong.lambda) lambda = -lambda;
  const std::string sentence = verify(wrong.data()).sentence(tolerance);
  EXPECT_NE(sentence.find("violated"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("multiplier below zero"), std::string::npos) << sentence;
  EXPECT_EQ(sentence.find("gap below zero"), std::string::npos) << sentence;
}

TEST(Kkt, refuses_data_that_can_not_be_judged) {
  KktData no_multiplier = Solution().data();
  no_multiplier.equilibrium.clear();
  EXPECT_THROW(verify(no_multiplier), core::Error);
  KktData no_scale = Solution().data();
  no_scale.multiplier_scale = 0;
  EXPECT_THROW(verify(no_scale), core::Error);
}

}  // namespace
}  // namespace thixis::complementarity::test
