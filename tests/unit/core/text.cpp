#include "thixis/core/text.hpp"

#include <gtest/gtest.h>

namespace thixis::core {

TEST(Text, the_nearest_name_is_found_without_regard_to_case) {
  const std::vector<std::string> names{"max iterations", "damping", "start"};
  EXPECT_EQ(nearest("max iteration", names), "max iterations");
  EXPECT_EQ(nearest("Damping", names), "damping");
  EXPECT_EQ(nearest("maximum iterations", names), "max iterations");
  EXPECT_EQ(nearest("tolerance", names), std::nullopt);
  EXPECT_EQ(nearest("x", {"f1"}), std::nullopt) << "nothing in common";
  EXPECT_EQ(did_you_mean("x", {"a2", "b2"}, "Write one of"), "Write one of a2, b2.");
}

TEST(Text, numbers_are_read_strictly) {
  EXPECT_EQ(to_double(" 1e-8 "), 1e-8);
  EXPECT_EQ(to_double("+.5"), 0.5);
  for (const char* text : {"", " ", "1e-8x", "nan", "inf", "-inf", "0x10", "1,5", "1 2", "1e999", "+-1", "+", "1d-8"})
    EXPECT_EQ(to_double(text), std::nullopt) << text;
  EXPECT_EQ(to_integer("-12"), -12);
  for (const char* text : {"", "3.0", "3x", "1e3", "99999999999999999999"}) EXPECT_EQ(to_integer(text), std::nullopt) << text;
}

TEST(Text, numbers_are_written_short_and_read_back_equal) {
  EXPECT_EQ(to_text(1e-8), "1e-8");
  EXPECT_EQ(to_text(0.1), "0.1");
  EXPECT_EQ(to_text(3), "3");
  EXPECT_EQ(to_text(1e22), "1e22");
  EXPECT_EQ(to_text(1e-10), "1e-10");
  for (const double x : {1.0 / 3, 1e-300, 6.02214076e23, -0.0}) EXPECT_EQ(to_double(to_text(x)), x);
}

}  // namespace thixis::core
