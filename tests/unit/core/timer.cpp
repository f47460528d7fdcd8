#include "thixis/core/timer.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "thixis/core/memory.hpp"

namespace thixis::core {

namespace {
void wait(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }
}  // namespace

TEST(Region, accumulates_and_nests) {
  reset_regions();
  for (int i = 0; i < 2; ++i) {
    const Region outer("outer");
    wait(2);
    const Region inner("inner");
    wait(4);
  }
  EXPECT_GE(seconds("inner"), 0.008);
  EXPECT_GE(seconds("outer"), seconds("inner") + 0.004);
  EXPECT_EQ(seconds("never entered"), 0);
  for (const auto& region : regions()) {
    if (region.name != "inner" && region.name != "outer") continue;
    EXPECT_EQ(region.calls, 2);
    EXPECT_EQ(region.depth, region.name == "inner" ? 1 : 0);
  }
}

TEST(Region, inside_itself_counts_once) {
  reset_regions();
  const Stopwatch watch;
  {
    const Region outer("recursive");
    const Region inner("recursive");
    wait(4);
    EXPECT_GE(seconds("recursive"), 0.004) << "a running region counts up to now";
  }
  EXPECT_LE(seconds("recursive"), watch.seconds());
}

TEST(Region, reset_sets_all_to_zero) {
  { const Region region("reset"); }
  reset_regions();
  EXPECT_EQ(seconds("reset"), 0);
}

TEST(Region, the_table_shows_the_slowest_rank) {
  reset_regions();
  const Comm comm;
  {
    const Region region("slow on the last");
    if (comm.rank() == comm.size() - 1) wait(20);
  }
  const std::string table = region_table(comm, 0.02);
  EXPECT_EQ(table.empty(), !comm.root());
  if (!comm.root()) return;
  const auto row = table.find("slow on the last");
  ASSERT_NE(row, std::string::npos);
  EXPECT_GE(std::stod(table.substr(row + std::string("slow on the last").size())), 0.02);
}

TEST(Memory, the_peak_grows_with_what_is_touched) {
  const double before = peak_memory_mb();
  EXPECT_GT(before, 1);
  const std::vector<char> block(static_cast<std::size_t>(before * 1e6) + 50000000, 1);
  EXPECT_GT(peak_memory_mb(), before + 40) << static_cast<int>(block[10]);
}

}  // namespace thixis::core
