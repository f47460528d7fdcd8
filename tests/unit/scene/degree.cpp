#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sample.hpp"
#include "thixis/core/error.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::scene::test {
namespace {

const std::map<std::string, double> constants = {{"R", 0.5}, {"n", 3}, {"half", 0.5}};

std::optional<Degree> degree(const std::string& text, std::optional<int> named = {}) {
  return expression("f", text, {0.25, 0.5}, constants, named)->degree();
}

/// "2,1" for degree 2 in place and 1 in time, with " in pieces"; "none".
std::string words(const std::optional<Degree>& degree) {
  if (!degree) return "none";
  return std::to_string(degree->space) + "," + std::to_string(degree->time) + (degree->whole ? "" : " in pieces");
}

TEST(Degree, of_a_polynomial_is_read_from_its_text) {
  for (const auto& [text, expected] : std::map<std::string, std::string>{{"3", "0,0"},
                                                                         {"sin(pi/4) + R^0.5", "0,0"},
                                                                         {"x", "1,0"},
                                                                         {"-x^2", "2,0"},
                                                                         {"2*x*y/3 - t", "2,1"},
                                                                         {"(x + y)^3*(1 - t)^2", "3,2"},
                                                                         {"x^n", "3,0"},
                                                                         {"x*-y", "2,0"},
                                                                         {"1e-3*x + .5e+2", "1,0"},
                                                                         {"r^2", "2,0"},
                                                                         {"(r^2 - R^2)^2", "4,0"},
                                                                         {"r*r*x", "3,0"},
                                                                         {"x^2/exp(2)", "2,0"},
                                                                         {"x^0", "0,0"},
                                                                         {"((x))^(1 + 1)", "none"},
                                                                         {"x^2^3", "none"},
                                                                         {"x^-1", "none"},
                                                                         {"x^half", "none"},
                                                                         {"2^x", "none"},
                                                                         {"1/x", "none"},
                                                                         {"r", "none"},
                                                                         {"r^3", "none"},
                                                                         {"(r^2 - R)*(r - R)", "none"},
                                                                         {"sin(x)", "none"},
                                                                         {"abs(x)", "none"},
                                                                         {"x < R ? 1 : 2", "none"},
                                                                         {"(x < R)*x", "none"},
                                                                         {"sqrt(x^2)", "none"}})
    EXPECT_EQ(words(degree(text)), expected) << text;
}

TEST(Degree, of_pieces_counts_where_the_user_says_that_cells_keep_to_one_of_them) {
  for (const auto& [text, expected] : std::map<std::string, std::string>{{"x < R ? 1 : 1e4", "0,0 in pieces"},
                                                                         {"x < R && sin(y) > 0 ? x : x*y", "2,0 in pieces"},
                                                                         {"x < R ? x : y < R ? 2 : 3*x^2", "2,0 in pieces"},
                                                                         {"0.3 - max(abs(x - 0.5), abs(y - 0.5))", "1,0 in pieces"},
                                                                         {"min(x, 1 - x, t)", "1,1 in pieces"},
                                                                         {"x^3", "3,0"},
                                                                         {"x < R ? x^4 : 0", "2,0 in pieces"},
                                                                         {"sin(x)", "2,0 in pieces"},
                                                                         {"sin(x*t)", "2,2 in pieces"}})
    EXPECT_EQ(words(degree(text, 2)), expected) << text;
}

/// A random text of the grammar.
class Texts {
 public:
  explicit Texts(int seed) : random_(seed) {}
  std::string operator()(int depth) {
    const auto part = [&] { return (*this)(depth - 1); };
    switch (depth == 0 ? pick(6) : 6 + pick(9)) {
      case 0:
        return "x";
      case 1:
        return "y";
      case 2:
        return "r";
      case 3:
        return "R";
      case 4:
        return "0.7";
      case 5:
        return "(x - y)";
      case 6:
        return part() + " + " + part();
      case 7:
        return part() + "*" + part();
      case 8:
        return "-" + part() + "^2";
      case 9:
        return "(" + part() + ")^" + std::to_string(pick(4));
      case 10:
        return part() + "/" + part();
      case 11:
        return "(" + part() + " - " + part() + ")";
      case 12:
        return "(" + part() + " < " + part() + " ? " + part() + " : " + part() + ")";
      case 13:
        return "abs(" + part() + ")";
      default:
        return part() + "^" + part();
    }
  }

 private:
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  std::mt19937 random_;
};

/// Differences of order degree + 1 along a line vanish.
TEST(Degree, is_never_below_that_of_the_function) {
  Texts text(1);
  int found = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string written = text(1 + i % 3);
    std::vector<double> value;
    try {
      const FieldPtr f = expression("f", written, {0.25, 0.5}, constants);
      if (!f->degree() || f->degree()->space > 12) continue;
      Sample along;
      const int last = f->degree()->space + 1;
      for (int k = 0; k <= last; ++k) along.add(0.13 + 0.61 * k / last, 0.94 - 0.83 * k / last);
      value = along(f);
    } catch (const core::InputError&) {
      continue;  // a division by zero
    }
    ++found;
    const int n = static_cast<int>(value.size());
    double size = 0, difference = 0, binomial = 1;
    for (int k = 0; k < n; ++k) {
      size += std::abs(binomial * value[k]);
      difference += (k % 2 == 0 ? 1 : -1) * binomial * value[k];
      binomial *= static_cast<double>(n - 1 - k) / (k + 1);
    }
    EXPECT_LE(std::abs(difference), 1e-11 * size) << written;
  }
  EXPECT_GE(found, 500);
}

/// 64^6 = 2^36 is 0 in 32 bits, and 64^5 = 2^30 is half of what they hold.
TEST(Degree, of_powers_of_powers_saturates) {
  const auto tower = [](std::string text, int floors, const std::string& power = "64") {
    for (int k = 0; k < floors; ++k) text = "(" + text + ")^" + power;
    return text;
  };
  std::string long_product = "x^100";
  for (int k = 0; k < 300; ++k) long_product += "*x^100*t^100";
  for (const auto& [text, expected] :
       std::map<std::string, std::string>{{"x^100*y^100", "200,0"},
                                          {tower("x", 1), "64,0"},
                                          {tower("x", 2), "1000,0"},
                                          {tower("1 - (x - 0.47)^2", 5), "1000,0"},
                                          {tower("1 - (x - 0.47)^2", 6), "1000,0"},
                                          {tower("1 - (x - 0.47)^2", 31, "2"), "1000,0"},
                                          {"-8 - 1e7*" + tower("1 - (x - 0.47)^2", 6), "1000,0"},
                                          {tower("1 + 1e-10*t", 6), "0,1000"},
                                          {tower("t*x", 8), "1000,1000"},
                                          {tower("r", 6), "1000,0"},
                                          {tower("r", 6) + "*r", "none"},
                                          {tower("x", 5) + "*" + tower("y", 5) + "*" + tower("x - y", 5), "1000,0"},
                                          {"1/" + tower("1 - 1e-10*x", 6), "none"},
                                          {"x^" + tower("1 - 1e-10*x", 6), "none"},
                                          {"x^(3*0 + " + tower("1 - 1e-10*x", 6) + ")", "none"},
                                          {tower("1 - 1e-10*x", 6) + "^x", "none"},
                                          {"sin(" + tower("1 - 1e-10*x", 6) + ")", "none"},
                                          {long_product, "1000,1000"}})
    EXPECT_EQ(words(degree(text)), expected) << text;
  EXPECT_EQ(words(degree("x < R ? " + tower("x", 6) + " : 0", 30)), "30,0 in pieces");
}

TEST(Degree, deep_texts_prove_nothing_and_do_no_harm) {
  std::string text = "x";
  for (int k = 0; k < 1000; ++k) text = "(" + text + ")";
  EXPECT_EQ(words(degree(text)), "none");
}

}  // namespace
}  // namespace thixis::scene::test
