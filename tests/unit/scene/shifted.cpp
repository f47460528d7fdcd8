#include "thixis/scene/shifted.hpp"

#include <gtest/gtest.h>

#include "sample.hpp"

namespace thixis::scene {
namespace {

FieldPtr height(const std::string& text, std::optional<int> named = {}) { return expression("height", text, {0, 0}, {}, named); }

double at(const FieldPtr& field, double x, double y, double t = 0) {
  Sample sample;
  sample.add(x, y);
  return sample(field, t).front();
}

}  // namespace

TEST(Shifted, has_the_values_of_the_sum) {
  const auto v = shifted(height("1e6 + 2*x - t"), -1e6);
  EXPECT_NEAR(at(v, 0.25, 0.5, 0.125), 0.375, 1e-9);
  EXPECT_EQ(*shifted(constant(3), -2)->constant(), 1);
  EXPECT_EQ(shifted(nullptr, 1), nullptr);
  const auto f = height("x");
  EXPECT_EQ(shifted(f, 0), f);
}

TEST(Shifted, is_as_steady_and_as_much_a_polynomial_as_before) {
  for (const char* text : {"1 + x", "1 + x*y + t", "sin(x)"}) {
    const auto f = height(text), v = shifted(f, -1);
    EXPECT_EQ(v->steady(), f->steady()) << text;
    ASSERT_EQ(v->degree().has_value(), f->degree().has_value()) << text;
    if (!f->degree()) continue;
    EXPECT_EQ(v->degree()->space, f->degree()->space) << text;
    EXPECT_EQ(v->degree()->time, f->degree()->time) << text;
    EXPECT_EQ(v->degree()->whole, f->degree()->whole) << text;
  }
  const auto named = shifted(height("x < 0.5 ? 1 : 2*x", 1), -1);
  ASSERT_TRUE(named->degree());
  EXPECT_FALSE(named->degree()->whole);
}

TEST(Shifted, knows_what_has_cancelled) {
  const auto f = height("1e6 + x");
  EXPECT_EQ(f->cancelled(), 0);
  EXPECT_EQ(shifted(f, -1e6)->cancelled(), 1e6);
  EXPECT_EQ(shifted(shifted(f, -1e6), 10)->cancelled(), 1e6);
}

}  // namespace thixis::scene
