/// The bound is a bound: never below the true error, at any iterate of any method.
#include <gtest/gtest.h>

#include <cmath>

#include "iterates.hpp"

namespace thixis::verification {
namespace {

using complementarity::CFunction;

/// The smallest index, and by how much the bound ever exceeds the sum of its parts.
struct Range {
  int count = 0;
  double least = INFINITY, excess = 0;
  std::size_t at = 0;
};

Range expect_a_bound(const Laid& laid, const Stop& stop, CFunction function, bool closely, const std::string& name) {
  const auto seen = iterates(laid, stop, function, closely ? 3 : 10, closely ? 60 : 12);
  Range range;
  for (std::size_t i = 0; i < seen.size(); ++i, ++range.count) {
    const auto& eta = seen[i].eta;
    range.excess = std::max(range.excess, eta.total / (eta.discretization + eta.linearization + eta.algebraic) - 1);
    if (seen[i].effectivity() < range.least) range.least = seen[i].effectivity(), range.at = i;
  }
  EXPECT_GE(seen.size(), 2u) << name;
  const Seen& worst = seen[range.at];
  EXPECT_GE(range.least, 1) << name << ": look " << range.at << " of " << seen.size() << ", bound " << worst.eta.total << " ("
                            << worst.eta.discretization << ", " << worst.eta.linearization << ", " << worst.eta.algebraic << "), error "
                            << worst.error;
  EXPECT_LE(range.excess, 1e-12) << name;
  return range;
}

/// Every method on the meshes up to `finest`; `thorough`: with every rule and both C-functions, otherwise these by turns.
void expect_bounds(const std::string& problem, int coarsest, int finest, bool thorough, int lowest = 1, int highest = 4) {
  int turn = 0, looks = 0;
  double least = INFINITY;
  for (int level = coarsest; level <= finest; ++level)
    for (int p = lowest; p <= highest; ++p)
      for (const auto& [name, method] : all_variants(p)) {
        ++turn;
        for (std::size_t way = 0; way < 2 * all_stops().size(); ++way) {
          if (!thorough && way != static_cast<std::size_t>(turn) % (2 * all_stops().size())) continue;
          const Stop& stop = all_stops()[way / 2];
          auto params = known_case(problem, level, method);
          params.newton.start = complementarity::Start::cold;
          params.linear = {};
          params.linear.form = stop.form;
          const auto function = way % 2 == 0 ? CFunction::min : CFunction::fischer_burmeister;
          const auto range = expect_a_bound(lay(params), stop, function, thorough,
                                            problem + ", T_" + std::to_string(level) + ", " + name + ", " + stop.name +
                                                (way % 2 == 0 ? ", min" : ", Fischer-Burmeister"));
          looks += range.count;
          least = std::min(least, range.least);
        }
      }
  std::cout << problem << ": " << looks << " iterates, least index " << least << '\n';
}

}  // namespace

class Guarantee : public ::testing::TestWithParam<std::string> {};
TEST_P(Guarantee, holds_at_the_iterates_of_every_method_on_the_coarsest_mesh) { expect_bounds(GetParam(), 0, 0, false); }
TEST_P(Guarantee, holds_at_the_iterates_of_degree_1_and_2_on_a_finer_mesh) { expect_bounds(GetParam(), 1, 1, false, 1, 2); }

std::string underscored(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name)
    if (letter == ' ') letter = '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(Cases, Guarantee, ::testing::ValuesIn(known_cases()), underscored);

/// Boundary data with more on a face than the lift resolves: waves of half a cell, and a peak.
TEST(BoundaryData, that_no_face_resolves_are_counted_in_the_bound) {
  for (const char* u1 : {"sin(64*pi*x)*exp(64*pi*(y-1))", "sin(40*pi*x)*exp(40*pi*(y-1))", "0.003*(y+0.003)/((x-0.47)^2+(y+0.003)^2)"})
    for (const int degree : {1, 2, 4}) {
      auto deck = data({{"f1", "0"}, {"u1", u1}, {"u2", "-10"}, {"lambda", "0"}}, 0);
      deck.method = by("fem", degree);
      deck.method.quadrature_order = 30;
      const Solved run = solve(deck);
      EXPECT_GE(run.outcome.discretization->estimate(*run.outcome.X).total, *run.outcome.energy_error) << u1 << ", degree " << degree;
    }
}

class FarGuarantee : public ::testing::TestWithParam<std::string> {};
TEST_P(FarGuarantee, holds_at_the_iterates_with_every_rule_and_c_function_on_T_0) { expect_bounds(GetParam(), 0, 0, true); }
TEST_P(FarGuarantee, holds_at_the_iterates_of_every_method_on_T_1) { expect_bounds(GetParam(), 1, 1, false); }
TEST_P(FarGuarantee, holds_at_the_iterates_of_every_method_on_T_2) { expect_bounds(GetParam(), 2, 2, false); }
TEST_P(FarGuarantee, holds_at_the_iterates_of_degree_1_on_T_3) { expect_bounds(GetParam(), 3, 3, false, 1, 1); }
INSTANTIATE_TEST_SUITE_P(Cases, FarGuarantee, ::testing::ValuesIn(known_cases()), underscored);

}  // namespace thixis::verification
