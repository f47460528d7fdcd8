#pragma once
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "thixis/core/comm.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {

/// The folder of all tests on so many ranks, in the folder where the test was built: wherever it is called from, nothing is left there.
inline std::filesystem::path scratch_folder(int ranks) {
  return std::filesystem::path(THIXIS_SCRATCH) / ("output_" + std::to_string(ranks));
}

/// A fresh folder for one test, of its own for each number of ranks.
inline std::string scratch(const std::string& name) {
  const core::Comm comm;
  const std::filesystem::path folder = scratch_folder(comm.size()) / name;
  comm.on_root([&] {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  });
  return folder.string();
}

inline std::string content(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The sentence of the error that the action throws, on all ranks; with its code.
inline std::string sentence_of(core::ExitCode code, const std::function<void()>& action) {
  try {
    action();
  } catch (const core::Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

/// Files can not grow beyond some bytes while it lives: a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

}  // namespace thixis::output
