#include "thixis/core/file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "thixis/core/comm.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/log.hpp"
#include "thixis/core/memory.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {
namespace {

namespace fs = std::filesystem;

/// A fresh folder of this rank.
fs::path folder() {
  const Comm comm;
  fs::path path = fs::path(THIXIS_SCRATCH) / ("files_" + std::to_string(comm.size())) / std::to_string(comm.rank());
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

using State = RegularFile::State;
State state(const fs::path& path) { return RegularFile(path.string()).state(); }

}  // namespace

TEST(RegularFile, is_read_to_its_end_and_not_beyond_a_limit) {
  const fs::path path = folder() / "file";
  const std::string content = std::string(100000, 'a') + '\0' + "b";
  std::ofstream(path) << content;
  EXPECT_EQ(RegularFile(path.string()).size(), content.size());
  EXPECT_EQ(RegularFile(path.string()).read_up_to(1 << 20), content);
  EXPECT_EQ(RegularFile(path.string()).read_up_to(content.size()), content);
  EXPECT_EQ(RegularFile(path.string()).read_up_to(10).size(), 11u) << "one more shows that there is more";
  fs::create_symlink(path, path.parent_path() / "link");
  EXPECT_EQ(RegularFile((path.parent_path() / "link").string()).read_up_to(1 << 20), content) << "links may be read";
}

TEST(RegularFile, is_nothing_else) {
  const fs::path place = folder();
  EXPECT_EQ(state(place), State::folder);
  EXPECT_EQ(state(place / "none"), State::absent);
  EXPECT_EQ(state(place / "none/none"), State::absent);
  EXPECT_EQ(state("/dev/zero"), State::special);
  EXPECT_EQ(state("/dev/null"), State::special);
  EXPECT_EQ(state(""), State::absent);
  ASSERT_EQ(::mkfifo((place / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(state(place / "pipe"), State::special) << "and nobody waits for a writer";
  fs::create_symlink("/dev/zero", place / "link");
  EXPECT_EQ(state(place / "link"), State::special);
  fs::create_symlink("loop", place / "loop");
  EXPECT_EQ(state(place / "loop"), State::unreadable);
  std::ofstream(place / "secret") << "x";
  fs::permissions(place / "secret", fs::perms::none);
  if (::geteuid() != 0) {
    EXPECT_EQ(state(place / "secret"), State::unreadable);
  }
}

TEST(PlainPlace, is_free_or_a_regular_file) {
  const fs::path place = folder();
  std::ofstream(place / "file") << "kept";
  fs::create_symlink("file", place / "link");
  fs::create_symlink("none", place / "dangling");
  ASSERT_EQ(::mkfifo((place / "pipe").c_str(), 0600), 0);
  EXPECT_NO_THROW(require_plain_place((place / "file").string()));
  EXPECT_NO_THROW(require_plain_place((place / "none").string()));
  for (const char* name : {"link", "dangling", "pipe", "."}) EXPECT_THROW(require_plain_place((place / name).string()), FileError) << name;
  if (!Comm().root()) return;
  EXPECT_THROW(log::open((place / "link").string()), FileError);
  EXPECT_THROW(log::open((place / "pipe").string()), FileError) << "and nobody waits for a reader";
  std::string content;
  std::ifstream(place / "file") >> content;
  EXPECT_EQ(content, "kept");
}

TEST(Printable, shows_words_and_nothing_but_words) {
  EXPECT_EQ(printable("a\tb\n\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80"), "a\tb\n\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80");
  EXPECT_EQ(printable("\x1b]0;title\x07\x1b[31m\r\b\x7f"), "\\x1b]0;title\\x07\\x1b[31m\\x0d\\x08\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m \x9b\xff \xe2\x80\xae"),
            "\\x9b31m \\x9b\\xff \\u202e");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(one_line("a\tb\nc"), "a\\x09b\\x0ac");
  for (int byte = 0; byte < 256; ++byte)
    for (const unsigned char c : one_line(std::string(1, static_cast<char>(byte)))) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << byte;
}

TEST(Shortened, keeps_both_ends_and_whole_letters) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcdefgh", 4), "ab ... gh");
  EXPECT_EQ(shortened("a\xc3\xa4xx\xc3\xa4y", 4), "a ... y");
}

TEST(Log, shows_what_others_wrote_as_words) {
  log::close();
  ::testing::internal::CaptureStdout();
  log::info("{}", "\x1b[2J'\xff'");
  std::fflush(stdout);
  log::close();
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), Comm().root() ? "\\x1b[2J'\\xff'\n" : "");
}

TEST(AsError, knows_errors_and_memory) {
  EXPECT_EQ(as_error(FileError("x")).code(), ExitCode::input_output);
  EXPECT_EQ(as_error(std::bad_alloc()).code(), ExitCode::input);
  EXPECT_EQ(as_error(std::runtime_error("Kokkos failed to allocate memory for label \"A\".")).code(), ExitCode::input);
  EXPECT_EQ(as_error(std::runtime_error("x")).code(), ExitCode::internal);
}

TEST(AsError, memory_that_a_rank_lacks_ends_all_with_a_sentence) {
  const Comm comm;
  const auto greedy = [&] {
    if (comm.rank() + 1 == comm.size()) throw std::bad_alloc();
  };
  try {
    comm.together(greedy);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("the memory of this machine is not enough"), 0u);
  }
}

}  // namespace thixis::core
