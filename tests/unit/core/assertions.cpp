#ifndef THIXIS_ASSERTIONS
#define THIXIS_ASSERTIONS
#endif
#include <gtest/gtest.h>

#include <cfenv>
#include <csignal>

#include "thixis/core/assert.hpp"
#include "thixis/core/error.hpp"

namespace thixis::core {

namespace {
template <class F>
std::string failure(F f) {
  try {
    f();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::internal);
    return error.what();
  }
  return "";
}
bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}
}  // namespace

TEST(Assertion, shows_the_condition_and_the_message) {
  const double volume = -1;
  EXPECT_EQ(failure([] { THIXIS_ASSERT(1 + 1 == 2); }), "");
  const std::string text = failure([&] { THIXIS_ASSERT(volume > 0, "cell {} has volume {}", 3, volume); });
  EXPECT_TRUE(ends_with(text, ": the assertion 'volume > 0' failed: cell 3 has volume -1")) << text;
}

TEST(Assertion, shows_both_values_of_a_comparison) {
  const int rows = 3, columns = 4;
  const std::string text = failure([&] { THIXIS_ASSERT_EQ(rows, columns, "patch {}", 7); });
  EXPECT_TRUE(ends_with(text, "the assertion 'rows == columns' failed: 3 and 4; patch 7")) << text;
  EXPECT_EQ(failure([&] { THIXIS_ASSERT_LT(rows, columns); }), "");
  EXPECT_NE(failure([&] { THIXIS_ASSERT_LE(columns, rows); }), "");
}

TEST(FloatingPointTraps, are_switched_off_for_a_while_only) {
  enable_floating_point_traps();
  EXPECT_EQ(fegetexcept(), FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  {
    const WithoutFloatingPointTraps quiet;
    volatile double zero = 0;
    EXPECT_GT(1 / zero, 1);
    EXPECT_EQ(fegetexcept(), 0);
  }
  EXPECT_EQ(fegetexcept(), FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  fedisableexcept(FE_ALL_EXCEPT);
}

}  // namespace thixis::core
