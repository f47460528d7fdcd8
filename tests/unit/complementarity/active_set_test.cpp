#include "thixis/complementarity/active_set.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <functional>

#include "views.hpp"

namespace thixis::complementarity {
namespace {

constexpr int points = 100;

/// K = difference(l), G = 0, s = 1 on `points` points over all ranks.
ActiveSet set_of(const std::function<double(int)>& difference, Ties ties = Ties::contact, double tolerance = 0) {
  const auto map = Teuchos::rcp(new algebra::Map(points, 0, Tpetra::getDefaultComm()));
  algebra::Vector K(map), G(map), s(map);
  for (int l = 0; l < algebra::local_size(*map); ++l) K.replaceLocalValue(l, difference(static_cast<int>(map->getGlobalElement(l))));
  s.putScalar(1);
  return ActiveSet(K, G, s, ties, tolerance * largest_argument(K, G, s));
}

TEST(ActiveSet, counts_contact_points_of_all_ranks) {
  EXPECT_EQ(set_of([](int l) { return l < 37 ? -1.0 : 1.0; }).count(), 37);
  EXPECT_EQ(set_of([](int) { return 1.0; }).count(), 0);
}

TEST(ActiveSet, counts_points_that_changed_on_all_ranks) {
  const ActiveSet a = set_of([](int l) { return l < 50 ? -1.0 : 1.0; }), b = set_of([](int l) { return l % 2 == 0 ? -1.0 : 1.0; });
  EXPECT_EQ(a.changed(b), 50);
  EXPECT_EQ(b.changed(a), 50);
  EXPECT_EQ(a.changed(a), 0);
}

TEST(ActiveSet, nothing_is_in_contact_in_a_default_constructed_set) {
  const ActiveSet a = set_of([](int l) { return l < 7 ? -1.0 : 1.0; });
  EXPECT_EQ(a.changed(ActiveSet()), 7);
  EXPECT_EQ(ActiveSet().changed(a), 7);
  EXPECT_EQ(ActiveSet().count(), 0);
}

TEST(ActiveSet, fingerprints_are_equal_for_equal_sets_and_differ_for_neighbours) {
  const ActiveSet a = set_of([](int l) { return l < 50 ? -1.0 : 1.0; });
  EXPECT_EQ(a.fingerprint(), set_of([](int l) { return l < 50 ? -2.0 : 3.0; }).fingerprint());
  for (int other = 0; other < points; ++other) {
    if (other != 50) {
      EXPECT_NE(a.fingerprint(), set_of([=](int l) { return l < other ? -1.0 : 1.0; }).fingerprint());
    }
    EXPECT_NE(a.fingerprint(), set_of([=](int l) { return (l < 50) != (l == other) ? -1.0 : 1.0; }).fingerprint());
  }
}

TEST(ActiveSet, fingerprint_does_not_depend_on_the_number_of_ranks) {
  EXPECT_EQ(set_of([](int l) { return l == 0 ? -1.0 : 1.0; }).fingerprint(), 0xe220a8397b1dcdafULL);  // splitmix64 of 0
  EXPECT_EQ(set_of([](int l) { return l == 0 || l == 99 ? -1.0 : 1.0; }).fingerprint() -
                set_of([](int l) { return l == 99 ? -1.0 : 1.0; }).fingerprint(),
            0xe220a8397b1dcdafULL);
}

TEST(ActiveSet, ties_go_where_they_are_sent) {
  const auto tie = [](int l) { return l < 10 ? 0.0 : l < 30 ? -1.0 : 1.0; };
  EXPECT_EQ(set_of(tie, Ties::contact).count(), 30);
  EXPECT_EQ(set_of(tie, Ties::free).count(), 20);
}

TEST(ActiveSet, tie_tolerance_is_relative_to_the_largest_argument_on_any_rank) {
  const auto noisy = [](int l) { return l == 99 ? 1e6 : l % 2 == 0 ? 1e-9 : -1e-9; };
  EXPECT_EQ(set_of(noisy, Ties::contact, 0).count(), 49);
  EXPECT_EQ(set_of(noisy, Ties::free, 0).count(), 49);
  EXPECT_EQ(set_of(noisy, Ties::contact, 1e-14).count(), 99);
  EXPECT_EQ(set_of(noisy, Ties::free, 1e-14).count(), 0);
  EXPECT_EQ(set_of(noisy, Ties::free, 1e-16).count(), 49);
}

}  // namespace
}  // namespace thixis::complementarity
