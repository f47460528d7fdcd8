#include <gtest/gtest.h>

#include "thixis/algebra/solver.hpp"

namespace thixis::algebra::testing {

TEST(LinearParams, are_described_with_the_names_of_the_deck) {
  const core::Description& description = LinearParams::schema().description();
  EXPECT_EQ(description.name(), "linear");
  for (const char* name :
       {"solver", "form", "preconditioner", "ilu level", "overlap", "ilut fill", "restart", "max iterations", "check every"})
    EXPECT_NE(description.parameter(name), nullptr) << name;
}

}  // namespace thixis::algebra::testing
