#include "thixis/scene/field.hpp"

#include <gtest/gtest.h>

#include "sample.hpp"
#include "thixis/core/error.hpp"

namespace thixis::scene {
namespace {

std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Field, of_a_number_says_that_it_is_constant) {
  EXPECT_EQ(*constant(3)->constant(), 3);
  EXPECT_EQ(*expression("f", "2*pi/pi + a", {0, 0}, {{"a", 1}})->constant(), 3);
  EXPECT_EQ(expression("f", "x", {0, 0}, {})->constant(), nullptr);
  EXPECT_EQ(expression("f", "t", {0, 0}, {})->constant(), nullptr);
}

TEST(Field, measures_r_from_the_centre_and_knows_time_and_constants) {
  const FieldPtr f = expression("f", "r < R ? x + 10*y : 100*t", {0.5, -0.25}, {{"R", 1.0 / 3}});
  const Sample sample = ring(0.5, -0.25, 0, 1, 3000);
  const auto values = sample(f, 7);
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const bool inside = std::hypot(sample.x[i] - 0.5, sample.y[i] + 0.25) < 1.0 / 3;
    EXPECT_NEAR(values[i], inside ? sample.x[i] + 10 * sample.y[i] : 700, 1e-13);
  }
}

TEST(Field, compiled_in_takes_two_or_three_arguments) {
  Sample sample;
  sample.add(2, 3);
  EXPECT_EQ(sample(formula([](double x, double y) { return x * y; }))[0], 6);
  EXPECT_EQ(sample(formula([](double x, double y, double t) { return x * y * t; }), 5)[0], 30);
}

TEST(Field, names_the_function_and_the_point_where_it_is_not_finite) {
  Sample sample;
  sample.add(1, 0);
  sample.add(0, 0);
  const std::string promised =
      "scene/data/f1: the value at x = 0, y = 0, t = 2 is not a finite number; write a function that is defined there.";
  EXPECT_EQ(message_of([&] { sample(expression("scene/data/f1", "1/r", {0, 0}, {}), 2); }), promised);
  EXPECT_EQ(message_of([&] { sample(formula([](double x, double) { return 1 / x; }, "scene/data/f1"), 2); }), promised);
  EXPECT_EQ(message_of([&] { expression("f", "1/0", {0, 0}, {}); }), "f: '1/0' is not a finite number.");
}

TEST(Field, names_the_function_that_is_too_large_for_products_of_data) {
  const std::string why =
      "too large to compute with, since products of data must be numbers, too: write the data in units in which they are at most 1e+60.";
  Sample sample;
  sample.add(2, 0);
  EXPECT_EQ(message_of([&] {
              sample(expression("scene/data/f1", "1e300*x", {0, 0}, {}));
            }),
            "scene/data/f1: the value at x = 2, y = 0, t = 0 is 2e+300, " + why);
  EXPECT_EQ(message_of([&] {
              sample(expression("scene/data/f1", "-1e60*x", {0, 0}, {}));
            }),
            "scene/data/f1: the value at x = 2, y = 0, t = 0 is -2e+60, " + why);
  EXPECT_EQ(message_of([&] { expression("f", "1e308", {0, 0}, {}); }), "f: 1e+308 is " + why);
}

TEST(Field, names_the_function_whose_expression_can_not_be_read) {
  EXPECT_EQ(message_of([] { expression("scene/data/f1", "sin(", {0, 0}, {}); }).find("scene/data/f1: "), 0u);
  EXPECT_NE(message_of([] { expression("scene/data/f1", "2 z", {0, 0}, {}); }).find("2 z"), std::string::npos);
}

TEST(DifferenceGradient, is_of_sixth_order) {
  const FieldPtr u = formula([](double x, double y) { return std::sin(2 * x + y) * std::exp(y); });
  const FieldPtr exact[2] = {formula([](double x, double y) { return 2 * std::cos(2 * x + y) * std::exp(y); }),
                             formula([](double x, double y) { return (std::cos(2 * x + y) + std::sin(2 * x + y)) * std::exp(y); })};
  const Sample sample = ring(0, 0, 0, 1);
  for (const int direction : {0, 1}) {
    const auto error = [&](double step) {
      const auto a = sample(exact[direction]), b = sample(difference_gradient(u, step)[direction]);
      double largest = 0;
      for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
      return largest;
    };
    EXPECT_NEAR(std::log2(error(0.2) / error(0.1)), 6, 0.2);
    EXPECT_LT(error(1e-2), 1e-11);
  }
  EXPECT_EQ(*difference_gradient(constant(4), 1e-3)[0]->constant(), 0);
}

}  // namespace
}  // namespace thixis::scene
