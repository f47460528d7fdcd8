#include "thixis/complementarity/c_function.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "thixis/complementarity/active_set.hpp"
#include "views.hpp"

namespace thixis::complementarity {
namespace {

/// C, a, b at given pairs, all on this rank (every rank has the same pairs).
struct Pairs {
  Pairs(CFunction function, const std::vector<double>& k, const std::vector<double>& g, double scaling = 1, Ties ties = Ties::contact) {
    const auto map =
        Teuchos::rcp(new algebra::Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), k.size(), 0, Tpetra::getDefaultComm()));
    algebra::Vector K(map), G(map), s(map), Cv(map), av(map), bv(map);
    for (std::size_t i = 0; i < k.size(); ++i) K.replaceLocalValue(i, k[i]), G.replaceLocalValue(i, g[i]);
    s.putScalar(scaling);
    const ActiveSet active(K, G, s, ties, 0);
    evaluate(function, K, G, s, active, Cv);
    differentiate(function, K, G, s, active, av, bv);
    C.assign(Cv.getData().begin(), Cv.getData().end());
    a.assign(av.getData().begin(), av.getData().end());
    b.assign(bv.getData().begin(), bv.getData().end());
  }
  std::vector<double> C, a, b;
};

const std::vector<CFunction> both = {CFunction::min, CFunction::fischer_burmeister};

TEST(CFunction, is_zero_exactly_at_complementary_pairs) {
  for (const CFunction function : both) {
    const Pairs zero(function, {0, 0, 3, 0, 1e-200, 1e200}, {0, 2, 0, 1e-12, 0, 0}, 7);
    for (const double C : zero.C) EXPECT_EQ(C, 0);
    const Pairs nonzero(function, {1, -1, -1, 1, 1e-3, -1e-9, 2}, {1, 1, -1, -1, 1e-3, 5, -1e-9}, 7);
    for (const double C : nonzero.C) EXPECT_GT(std::abs(C), 1e-10);
  }
}

TEST(CFunction, has_the_documented_sign_inside_and_outside_of_the_quadrant) {
  const Pairs min(CFunction::min, {1, -1}, {2, 2}), fb(CFunction::fischer_burmeister, {3, -3}, {4, 4});
  EXPECT_EQ(min.C[0], 1);
  EXPECT_EQ(min.C[1], -1);
  EXPECT_NEAR(fb.C[0], 5 - 7, 1e-15);
  EXPECT_NEAR(fb.C[1], 5 - 1, 1e-15);
}

TEST(CFunction, derivatives_agree_with_differences_away_from_the_kinks) {
  const std::vector<double> k = {2, -2, 0.3, -0.7, 5, 1e-3}, g = {1, 1, 0.9, -0.6, -3, 2};
  const double s = 0.7, t = 1e-6;
  for (const CFunction function : both) {
    const Pairs at(function, k, g, s);
    auto k_up = k, k_down = k, g_up = g, g_down = g;
    for (std::size_t i = 0; i < k.size(); ++i) k_up[i] += t, k_down[i] -= t, g_up[i] += t, g_down[i] -= t;
    const Pairs ku(function, k_up, g, s), kd(function, k_down, g, s), gu(function, k, g_up, s), gd(function, k, g_down, s);
    for (std::size_t i = 0; i < k.size(); ++i) {
      EXPECT_NEAR(at.a[i], (ku.C[i] - kd.C[i]) / (2 * t), 1e-8) << i;
      EXPECT_NEAR(at.b[i], (gu.C[i] - gd.C[i]) / (2 * t), 1e-8) << i;
    }
  }
}

/// C(z + d) - C(z) - V(z + d) d = o(|d|) at the kinks, too: here it even vanishes, C being positively homogeneous about them.
TEST(CFunction, is_semismooth_at_the_origin_and_on_the_diagonal) {
  for (double size = 1; size > 1e-8; size /= 10) {
    for (int direction = 0; direction < 24; ++direction) {
      const double angle = 0.1 + direction * std::acos(-1.0) / 12, dk = size * std::cos(angle), dg = size * std::sin(angle);
      for (const CFunction function : both) {
        const Pairs origin(function, {dk}, {dg});
        EXPECT_NEAR(origin.C[0] - origin.a[0] * dk - origin.b[0] * dg, 0, 1e-15 * size);
      }
      const Pairs diagonal(CFunction::min, {1 + dk}, {1 + dg});
      EXPECT_NEAR(diagonal.C[0] - 1 - diagonal.a[0] * dk - diagonal.b[0] * dg, 0, 1e-15);
    }
  }
}

TEST(CFunction, fischer_burmeister_keeps_all_digits_when_one_argument_is_tiny) {
  const Pairs p(CFunction::fischer_burmeister, {1, 1e-10, 1e8, 1e-300, 1e200}, {1e-10, 1, 1e-8, 1e-300, 1e200});
  EXPECT_NEAR(p.C[0], -1e-10 + 0.5e-20, 1e-25);  // √(1+t²) - 1 - t = -t + t²/2
  EXPECT_NEAR(p.C[1], -1e-10 + 0.5e-20, 1e-25);
  EXPECT_NEAR(p.C[2], -1e-8, 1e-22);
  EXPECT_NEAR(p.C[3] / 1e-300, std::sqrt(2.0) - 2, 1e-14);
  EXPECT_NEAR(p.C[4] / 1e200, std::sqrt(2.0) - 2, 1e-14);
  EXPECT_NEAR(p.a[0], -0.5e-20, 1e-34);  // 1/√(1+t²) - 1 = -t²/2
  EXPECT_NEAR(p.b[1], -0.5e-20, 1e-34);
  EXPECT_NEAR(p.b[0], 1e-10 - 1, 1e-15);
}

TEST(CFunction, fischer_burmeister_at_the_origin_takes_an_element_of_the_b_subdifferential) {
  const Pairs p(CFunction::fischer_burmeister, {0}, {0}, 3);
  EXPECT_NEAR(std::pow(p.a[0] + 1, 2) + std::pow(p.b[0] / 3 + 1, 2), 1, 1e-15);
  EXPECT_LT(p.a[0], 0);
  EXPECT_LT(p.b[0], 0);
}

TEST(CFunction, fischer_burmeister_derivatives_never_vanish_together) {
  std::vector<double> k, g;
  for (int i = 0; i < 64; ++i) k.push_back(std::cos(i * 0.1)), g.push_back(std::sin(i * 0.1));
  const Pairs p(CFunction::fischer_burmeister, k, g, 2);
  for (std::size_t i = 0; i < k.size(); ++i) {
    EXPECT_LE(p.a[i], 0);
    EXPECT_LE(p.b[i], 0);
    EXPECT_LT(p.a[i] + p.b[i] / 2, -0.58);
  }
}

TEST(CFunction, min_takes_the_gap_row_in_contact_and_the_scaled_multiplier_row_elsewhere) {
  const Pairs p(CFunction::min, {1, 5}, {1, 1}, 3);  // s G = 3
  EXPECT_EQ(p.C, (std::vector<double>{1, 3}));
  EXPECT_EQ(p.a, (std::vector<double>{1, 0}));
  EXPECT_EQ(p.b, (std::vector<double>{0, 3}));
}

TEST(CFunction, min_gives_ties_to_the_side_that_is_asked_for) {
  EXPECT_EQ(Pairs(CFunction::min, {0}, {0}, 2, Ties::contact).a[0], 1);
  EXPECT_EQ(Pairs(CFunction::min, {0}, {0}, 2, Ties::free).a[0], 0);
  EXPECT_EQ(Pairs(CFunction::min, {0}, {0}, 2, Ties::free).b[0], 2);
}

TEST(CFunction, passes_on_what_is_not_finite_in_either_argument) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const CFunction function : both)
    for (const double C : Pairs(function, {nan, 1, nan, -infinity}, {1, nan, nan, 1}).C) EXPECT_FALSE(std::isfinite(C));
}

}  // namespace
}  // namespace thixis::complementarity
