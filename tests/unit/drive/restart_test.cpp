#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "estimated_model.hpp"
#include "output/scratch.hpp"
#include "thixis/drive/run.hpp"

namespace thixis::drive::test {
namespace {

RunParams adaptive(int levels) {
  RunParams params = smooth_contact();
  params.adapt.emplace();
  params.adapt->max_levels = levels;
  params.output.checkpoint_every = 1000;
  return params;
}

nlohmann::json summary_of(RunParams params, const std::string& directory, const output::StoredCheckpoint* stored = nullptr) {
  params.output.directory = directory;
  const EstimatedModel model(params);
  run(params, model, core::Deck::from_text("<ParameterList name=\"thixis\"/>", "test.xml"), core::Comm(), {}, stored);
  return nlohmann::json::parse(output::content(directory + "/summary.json"));
}

void expect_same(const nlohmann::json& a, const nlohmann::json& b) {
  for (const char* key : {"cells", "unknowns", "active_points", "exit_code"}) EXPECT_EQ(a[key], b[key]) << key;
  for (const char* key : {"energy_error", "effectivity"}) EXPECT_NEAR(a[key].get<double>(), b[key].get<double>(), 1e-8) << key;
}

TEST(Restart, an_adaptive_run_builds_its_meshes_again_and_goes_on) {
  const std::string folder = output::scratch("restart");
  summary_of(adaptive(3), folder + "/cut");
  const auto whole = summary_of(adaptive(5), folder + "/whole");
  {
    const auto stored = output::read_checkpoint(folder + "/cut/checkpoint.h5", core::Comm());
    EXPECT_EQ(stored.level(), 4);
    expect_same(summary_of(adaptive(5), folder + "/on", &stored), whole);
  }
  // the checkpoint behind a restart knows the older meshes, too
  const auto again = output::read_checkpoint(folder + "/on/checkpoint.h5", core::Comm());
  expect_same(summary_of(adaptive(5), folder + "/again", &again), whole);
}

TEST(Restart, another_mesh_of_the_deck_is_refused) {
  const std::string folder = output::scratch("restart_refused");
  summary_of(adaptive(2), folder);
  const auto stored = output::read_checkpoint(folder + "/checkpoint.h5", core::Comm());
  for (const int refinements : {0, 2, 3}) {
    RunParams params = adaptive(3);
    params.mesh.refinements = refinements;
    EXPECT_THROW(summary_of(params, folder + "/refused", &stored), core::InputError) << refinements;
  }
  RunParams params = adaptive(3);
  params.mesh.cells_per_side = 5;
  EXPECT_THROW(summary_of(params, folder + "/refused", &stored), core::InputError);
}

TEST(Restart, finds_the_deck_of_the_same_directory) {
  const std::string folder = output::scratch("restart_history");
  summary_of(adaptive(1), folder + "/cut");
  const auto stored = output::read_checkpoint(folder + "/cut/checkpoint.h5", core::Comm());
  const auto rows = [&] {
    const std::string text = output::content(folder + "/cut/history.csv");
    return std::count(text.begin(), text.end(), '\n');
  };
  const auto before = rows();
  summary_of(adaptive(2), folder + "/cut", &stored);
  EXPECT_GT(rows(), before);
}

}  // namespace
}  // namespace thixis::drive::test
