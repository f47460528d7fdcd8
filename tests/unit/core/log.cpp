#include "thixis/core/log.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>

#include "thixis/core/comm.hpp"
#include "thixis/core/error.hpp"

namespace thixis::core {

namespace {
std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// What `f` prints to the terminal; begins and ends with a fresh log.
template <class F>
std::string printed(F f) {
  log::close();
  ::testing::internal::CaptureStdout();
  f();
  std::fflush(stdout);
  log::close();
  log::set_level(log::Level::normal);
  return ::testing::internal::GetCapturedStdout();
}

std::string file_of_this_rank() {
  const Comm comm;
  return ::testing::TempDir() + "thixis_log_" + std::to_string(comm.size()) + "_" + std::to_string(comm.rank()) + ".txt";
}
}  // namespace

TEST(Log, the_file_shows_what_the_terminal_showed_also_before_it_was_opened) {
  const std::string path = file_of_this_rank();
  std::remove(path.c_str());
  const std::string shown = printed([&] {
    log::info("step {:>3}", 1);
    log::detail("not shown");
    log::open(path);
    log::warn("careful");
    log::error("wrong\nsecond line");
    log::verdict("done in {} steps.", 1);
  });
  const bool root = Comm().root();
  EXPECT_EQ(shown, root ? "step   1\nwarning: careful\nerror: wrong\nsecond line\ndone in 1 steps.\n" : "");
  EXPECT_EQ(content(path), shown);
  std::remove(path.c_str());
}

TEST(Log, keeps_the_lines_of_an_older_run_where_asked_to) {
  const std::string path = file_of_this_rank();
  std::remove(path.c_str());
  for (const auto old : {log::Old::overwrite, log::Old::keep, log::Old::keep, log::Old::overwrite, log::Old::keep})
    printed([&] {
      log::open(path, old);
      log::info("line");
      log::close();
    });
  EXPECT_EQ(content(path), Comm().root() ? "line\nline\n" : "");
  std::remove(path.c_str());
}

TEST(Log, levels_choose_what_is_shown) {
  const auto all = [] {
    log::info("info");
    log::detail("detail");
    log::warn("warning");
    log::verdict("verdict");
  };
  if (!Comm().root()) return;
  EXPECT_EQ(printed([&] { log::set_level(log::Level::quiet), all(); }), "warning: warning\nverdict\n");
  EXPECT_EQ(printed([&] { log::set_level(log::Level::normal), all(); }), "info\nwarning: warning\nverdict\n");
  EXPECT_EQ(printed([&] { log::set_level(log::Level::verbose), all(); }), "info\ndetail\nwarning: warning\nverdict\n");
}

TEST(Log, a_file_that_can_not_be_written_is_an_error_of_the_root) {
  if (Comm().root()) EXPECT_THROW(log::open("/dev/null/no/log.txt"), FileError);
  else EXPECT_NO_THROW(log::open("/dev/null/no/log.txt"));
}

TEST(Log, braces_in_a_line_are_text) {
  const std::string shown = printed([] { log::info("{}", "value=\"{1, 2}\""); });
  EXPECT_EQ(shown, Comm().root() ? "value=\"{1, 2}\"\n" : "");
}

TEST(Progress, shows_nothing_where_there_is_no_terminal) {
  EXPECT_EQ(printed([] {
              log::Progress progress("time steps");
              progress.update(0.5);
            }),
            "");
}

TEST(Progress, estimates_the_time_left) {
  EXPECT_EQ(log::progress_text("steps", 0.25, 30, "t = 1"), "steps [=======>                      ] 25 %, 1 min 30 s left  t = 1");
  EXPECT_EQ(log::progress_text("steps", 0, 30), "steps [>                             ] 0 %");
  EXPECT_EQ(log::progress_text("steps", 1, 30), "steps [==============================] 100 %, 0 s left");
  EXPECT_EQ(log::duration_text(7500), "2 h 5 min");
  EXPECT_EQ(log::duration_text(std::numeric_limits<double>::infinity()), "unknown time");
}

}  // namespace thixis::core
