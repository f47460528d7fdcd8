/// Damaged checkpoints: each is refused with a sentence, or it is the whole one.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "mutate.hpp"
#include "thixis/core/error.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::fuzz {
namespace {

namespace fs = std::filesystem;

output::Checkpoint example() {
  output::Checkpoint checkpoint;
  checkpoint.deck = "<ParameterList name=\"thixis\">\n" + std::string(3000, ' ') + "</ParameterList>\n";
  checkpoint.folder = "/some/where";
  checkpoint.level = 3;
  for (const char* name : {"time", "next_length", "newton_iterations", "linear_iterations", "history_rows", "seconds", "retries"})
    checkpoint.attributes[name] = 1;
  for (const char* name : {"u1", "u2", "lambda"}) {
    output::CheckpointBlock block{name, {}, {}};
    for (int i = 0; i < 100; ++i) block.ids.push_back(i), block.values.push_back(0.25 * i);
    checkpoint.blocks.push_back(block);
  }
  return checkpoint;
}

}  // namespace

TEST(mutants, of_checkpoints_are_refused_unless_they_are_whole) {
  const core::Comm comm;
  const fs::path folder = fs::path(THIXIS_SCRATCH) / "checkpoints";
  fs::create_directories(folder);
  const std::string path = (folder / "whole.h5").string(), damaged = (folder / "damaged.h5").string();
  output::write_checkpoint(path, example(), comm);
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  const std::string whole = bytes.str();
  int refused = 0;
  const int count = mutants(3000);
  for (int seed = 0; seed < count; ++seed) {
    const std::string text = mutant(whole, static_cast<std::uint64_t>(seed));
    std::ofstream(damaged, std::ios::binary) << text;
    try {
      output::read_checkpoint(damaged, comm);
      EXPECT_TRUE(text == whole) << "seed " << seed;
    } catch (const core::FileError& error) {
      const std::string sentence = error.what();
      EXPECT_TRUE(sentence.find("is damaged") != std::string::npos || sentence.find("is no checkpoint") != std::string::npos) << sentence;
      ++refused;
    }
  }
  EXPECT_GT(refused, count * 4 / 5);
}

}  // namespace thixis::fuzz
