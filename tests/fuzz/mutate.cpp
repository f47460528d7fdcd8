#include "mutate.hpp"

#include <gtest/gtest.h>

#include <set>

namespace thixis::fuzz {
namespace {

const std::string text = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0.5 1e-3 0\n$EndNodes\n";

}  // namespace

TEST(mutants, are_the_same_for_the_same_seed) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) EXPECT_EQ(mutant(text, seed), mutant(text, seed));
}

TEST(mutants, are_many_and_damaged) {
  std::set<std::string> different;
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const std::string damaged = mutant(text, seed);
    different.insert(damaged);
    whole += damaged == text ? 1 : 0;
  }
  EXPECT_GT(different.size(), 600u);
  EXPECT_LT(whole, 150);
}

TEST(mutants, of_little_or_nothing_exist) {
  for (const std::string& whole : {std::string(), std::string("x"), std::string("\n"), std::string(3, '\0')})
    for (std::uint64_t seed = 0; seed < 1000; ++seed) EXPECT_LT(mutant(whole, seed).size(), 1000u);
}

}  // namespace thixis::fuzz
