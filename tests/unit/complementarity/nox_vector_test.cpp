#include "nox_vector.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>
#include <limits>

namespace thixis::complementarity {
namespace {

/// v_i = factor (i + 1), i = 0 ... 9, over all ranks.
NoxVector counting(double factor) {
  const auto map = Teuchos::rcp(new algebra::Map(10, 0, Tpetra::getDefaultComm()));
  NoxVector v(map);
  for (int l = 0; l < algebra::local_size(*map); ++l)
    v.values().replaceLocalValue(l, factor * (static_cast<double>(map->getGlobalElement(l)) + 1));
  return v;
}

TEST(NoxVector, has_the_norms_and_products_of_all_ranks) {
  const NoxVector v = counting(-1);
  EXPECT_NEAR(v.norm(NOX::Abstract::Vector::TwoNorm), std::sqrt(385.0), 1e-12);
  EXPECT_EQ(v.norm(NOX::Abstract::Vector::OneNorm), 55);
  EXPECT_EQ(v.norm(NOX::Abstract::Vector::MaxNorm), 10);
  EXPECT_EQ(v.innerProduct(counting(2)), -770);
  EXPECT_NEAR(v.norm(counting(1)), std::sqrt(3025.0), 1e-12);  // Σ i i²
  EXPECT_EQ(v.length(), 10);
}

TEST(NoxVector, follows_the_algebra_of_nox) {
  NoxVector v = counting(1);
  v.update(2, counting(1), 3, counting(-1), 4);
  EXPECT_EQ(v.norm(NOX::Abstract::Vector::OneNorm), 3 * 55);
  v.update(1, counting(1), -1);
  EXPECT_EQ(v.norm(NOX::Abstract::Vector::OneNorm), 2 * 55);
  v.scale(counting(1));
  EXPECT_EQ(v.norm(NOX::Abstract::Vector::OneNorm), 2 * 385);
  v.abs(counting(-1));
  EXPECT_EQ(v.innerProduct(counting(1)), 385);
  v.reciprocal(counting(1));
  EXPECT_NEAR(v.innerProduct(counting(1)), 10, 1e-14);
  v.scale(2);
  EXPECT_NEAR(v.innerProduct(counting(1)), 20, 1e-14);
  v.init(3);
  EXPECT_EQ(v.norm(NOX::Abstract::Vector::OneNorm), 30);
}

TEST(NoxVector, clones_are_independent) {
  NoxVector v = counting(1);
  const auto deep = v.clone(NOX::DeepCopy), shape = v.clone(NOX::ShapeCopy);
  v.init(0);
  EXPECT_EQ(deep->norm(NOX::Abstract::Vector::OneNorm), 55);
  EXPECT_EQ(shape->length(), 10);
}

/// Backtracking overwrites an iterate with NaN by a better one.
TEST(NoxVector, overwriting_forgets_nan) {
  NoxVector v = counting(std::numeric_limits<double>::quiet_NaN());
  v.update(1, counting(1), 1, counting(1), 0);
  EXPECT_EQ(v.norm(NOX::Abstract::Vector::OneNorm), 110);
  v = counting(std::numeric_limits<double>::quiet_NaN());
  static_cast<NOX::Abstract::Vector&>(v) = counting(1);
  EXPECT_EQ(v.norm(NOX::Abstract::Vector::OneNorm), 55);
}

}  // namespace
}  // namespace thixis::complementarity
