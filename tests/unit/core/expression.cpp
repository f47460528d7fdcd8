#include "thixis/core/expression.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>

#include "core/params.hpp"
#include "thixis/core/assert.hpp"

namespace thixis::core::test {

namespace {
double value(const std::string& text, double x = 0, double y = 0) { return Expression(text, {"x", "y"}, {{"R", 0.5}})({x, y}); }
std::string mistake(const std::string& text) {
  return input_error([&] { Expression(text, {"x", "y"}, {{"R", 0.5}}); });
}
}  // namespace

TEST(Expression, follows_the_rules_of_arithmetic) {
  EXPECT_EQ(value("1 + 2*x^2", 3), 19);
  EXPECT_EQ(value("-x^2", 3), -9);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("7/2"), 3.5);
  EXPECT_EQ(value("1e-3*x + 1.5E+2", 2), 150.002);
  EXPECT_DOUBLE_EQ(value("sin(pi/6)"), 0.5);
  EXPECT_DOUBLE_EQ(value("log(exp(2))"), 2);
  EXPECT_EQ(value("max(x, y) - min(x, y)", 1, 4), 3);
}

TEST(Expression, knows_conditions_and_constants) {
  EXPECT_EQ(value("x < R ? 1 : 2", 0.25), 1);
  EXPECT_EQ(value("x < R ? 1 : 2", 0.75), 2);
  EXPECT_EQ(value("x > 0 && y > 0", 1, 1), 1);
  EXPECT_EQ(value("x > 0 && y > 0", 1, -1), 0);
  EXPECT_EQ(value("x > 0 || y > 0", 1, -1), 1);
  EXPECT_EQ(value("x == y ? 1 : x != y ? 2 : 3", 1, 2), 2);
  EXPECT_EQ(value("x >= 1 && x <= 2 ? y : -y", 1, 5), 5);
}

TEST(Expression, is_evaluated_at_many_points_at_once) {
  const Expression f("x + 10*y", {"x", "y"}, {});
  const std::vector<double> x{1, 2, 3}, y{4, 5, 6};
  const double* variables[] = {x.data(), y.data()};
  std::vector<double> values(3);
  f.evaluate(3, variables, values.data());
  EXPECT_EQ(values, (std::vector<double>{41, 52, 63}));
}

TEST(Expression, knows_which_variables_it_uses) {
  const Expression f("x*R", {"x", "t"}, {{"R", 1}}), one("2*R", {"x", "t"}, {{"R", 1}});
  EXPECT_TRUE(f.uses("x"));
  EXPECT_FALSE(f.uses("t"));
  EXPECT_FALSE(f.constant());
  EXPECT_TRUE(one.constant());
  EXPECT_EQ(f.text(), "x*R");
}

TEST(Expression, knows_what_its_hints_say) {
  EXPECT_EQ(value("x < 1 && y < 1", 0, 2), 0);
  EXPECT_EQ(value("x < 1 || y < 1", 0, 2), 1);
  EXPECT_EQ(value("!(x < 1) + 2*!(y < 1)", 0, 2), 2);
  EXPECT_EQ(value("x != y", 0, 2), 1);
  EXPECT_EQ(value("x - 3*rint(x/3 - 0.5)", 7.5), 1.5);
  EXPECT_EQ(value("2*sin(0*x) + 1e3*R"), 500);
}

TEST(Expression, does_not_depend_on_the_locale) {
  const WithDecimalComma german;
  EXPECT_EQ(value("max(1.5, x) * 1000", 0), 1500);
}

TEST(Expression, survives_being_moved) {
  Expression f("x", {"x"}), g("2*x", {"x"});
  g = std::move(f);
  const Expression h = std::move(g);
  EXPECT_EQ(h({3}), 3);
}

TEST(Expression, gives_infinity_and_nan_without_a_signal) {
  const int before = fegetexcept();
  enable_floating_point_traps();
  EXPECT_TRUE(std::isinf(value("1/x", 0)));
  EXPECT_TRUE(std::isinf(value("1/0")));
  EXPECT_TRUE(std::isnan(value("sqrt(x)", -1)));
  EXPECT_EQ(fegetexcept() & FE_DIVBYZERO, FE_DIVBYZERO) << "the traps are on again";
  fedisableexcept(FE_ALL_EXCEPT);
  feenableexcept(before);
}

TEST(Expression, says_what_is_wrong_with_the_text) {
  EXPECT_EQ(mistake(""), "the expression '' is empty; write a number or an expression.");
  EXPECT_EQ(mistake("  "), "the expression '  ' is empty; write a number or an expression.");
  EXPECT_EQ(mistake("2*(x + y"), "the expression '2*(x + y' lacks a ')'; close every parenthesis.");
  EXPECT_EQ(mistake("((x"), "the expression '((x' lacks 2 times ')'; close every parenthesis.");
  EXPECT_EQ(mistake("x)"), "the expression 'x)' has a ')' without its '('; remove it or open the parenthesis before.");
  EXPECT_EQ(mistake("sinn(x)"), "the expression 'sinn(x)' has the unknown name 'sinn'; did you mean 'sin'?");
  EXPECT_EQ(mistake("radius + x"),
            "the expression 'radius + x' has the unknown name 'radius'; known are x, y, pi, R and functions such as sin.");
  EXPECT_EQ(mistake("x +"), "the expression 'x +' ends too early; complete it.");
  EXPECT_EQ(mistake("x = 1 ? 2 : 3"), "the expression 'x = 1 ? 2 : 3' has a single '='; write == to compare.");
  EXPECT_EQ(mistake("x > 1 ? 2"), "the expression 'x > 1 ? 2' has a '?' without its ':' or the other way round; write condition ? a : b.");
  EXPECT_EQ(mistake("1,5*x"), "the expression '1,5*x' has a ',' outside of a function; write a decimal point as '.'.");
  EXPECT_EQ(mistake("sin(x, y)"), "the expression 'sin(x, y)' gives too many arguments to 'sin'.");
  EXPECT_EQ(mistake("atan2(x)"), "the expression 'atan2(x)' gives too few arguments to 'atan2'.");
  EXPECT_EQ(mistake("2x"), "the expression '2x' has '2x'; write 2*x.");
  EXPECT_EQ(mistake("x + 1e-3y"), "the expression 'x + 1e-3y' has '1e-3y'; write 1e-3*y.");
  EXPECT_EQ(mistake("sin x"), "the expression 'sin x' has 'sin' without a '('; write sin(...).");
  EXPECT_EQ(mistake("x**2"), "the expression 'x**2' has a '**'; write ^ for powers.");
  EXPECT_EQ(mistake("x < 1 and y < 1"), "the expression 'x < 1 and y < 1' has the word 'and'; write &&.");
  EXPECT_EQ(mistake("x < 1 or y < 1"), "the expression 'x < 1 or y < 1' has the word 'or'; write ||.");
  EXPECT_EQ(mistake("not (x < 1)"), "the expression 'not (x < 1)' has the word 'not'; write !.");
  EXPECT_EQ(mistake("x % 2"),
            "the expression 'x % 2' has a '%', which means nothing here; the remainder of a by b is a - b*rint(a/b - 0.5).");
  EXPECT_EQ(mistake("nan"), "the expression 'nan' has the unknown name 'nan'; did you mean 'tan'?");
}

TEST(Expression, refuses_constants_that_hide_something) {
  EXPECT_EQ(input_error([] {
              Expression("x", {"x"}, {{"sin", 1}});
            }),
            "the constant 'sin' of the expression 'x' has the name of something else; rename it.");
  EXPECT_EQ(input_error([] {
              Expression("x", {"x"}, {{"x", 1}});
            }),
            "the constant 'x' of the expression 'x' has the name of something else; rename it.");
  EXPECT_EQ(input_error([] {
              Expression("x", {"x"}, {{"a b", 1}});
            }),
            "'a b' can not be the name of a constant; use letters, digits and _, a letter first.");
}

}  // namespace thixis::core::test
