#include "thixis/output/summary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scratch.hpp"

namespace thixis::output {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> result;
  for (const auto& entry : object.items()) result.push_back(entry.key());
  return result;
}

/// What is read back from the file.
Json written(const Summary& summary) {
  const core::Comm comm;
  const std::string path = scratch("summary") + "/summary.json";
  summary.write(path, comm);
  const Json result = Json::parse(content(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  comm.barrier();
  return result;
}

}  // namespace

TEST(summary, has_the_documented_keys_in_their_order) {
  const Json json = written(Summary());
  EXPECT_EQ(keys(json), (std::vector<std::string>{"verdict",       "exit_code",
                                                  "model",         "case",
                                                  "method",        "degree",
                                                  "ranks",         "threads",
                                                  "cells",         "unknowns",
                                                  "nonzeros",      "newton_iterations",
                                                  "newton_finest", "linear_iterations",
                                                  "energy_error",  "energy_norm",
                                                  "estimate",      "estimate_published",
                                                  "effectivity",   "effectivity_published",
                                                  "kkt",           "active_points",
                                                  "time",          "memory_mb",
                                                  "versions"}));
  EXPECT_EQ(keys(json["unknowns"]), (std::vector<std::string>{"all", "global"}));
  EXPECT_EQ(keys(json["kkt"]), (std::vector<std::string>{"infeasible", "negative", "complementary", "between_nodes", "equilibrium"}));
  EXPECT_EQ(keys(json["time"]), (std::vector<std::string>{"total", "mesh", "assembly", "preconditioner", "linear", "estimate", "output"}));
  EXPECT_TRUE(json["versions"].is_object());
  for (const char* key :
       {"energy_error", "energy_norm", "estimate", "estimate_published", "effectivity", "effectivity_published", "active_points"})
    EXPECT_TRUE(json[key].is_null()) << key;
  for (const auto& value : json["kkt"]) EXPECT_TRUE(value.is_null());
}

TEST(summary, is_read_back_as_it_was) {
  Summary s;
  s.verdict = "The run \"disk\" converged\n\xe2\x89\xa4 1e-3.";
  s.exit_code = 4;
  s.model = "membranes";
  s.problem_case = "disk";
  s.method = "hho";
  s.degree = 3;
  s.ranks = 2;
  s.threads = 5;
  s.cells = 5000000000ll;
  s.unknowns.all = 11;
  s.unknowns.global = 12;
  s.nonzeros = 13;
  s.newton_iterations = 14;
  s.newton_finest = 15;
  s.linear_iterations = 16;
  s.energy_error = 1.0 / 3;
  s.energy_norm = 17;
  s.estimate.emplace(SummaryEstimate{1.5, 1.25, 0.125, 0.0625, "guaranteed", {}, {}});
  s.estimate_published.emplace(SummaryEstimate{2.5, 2.25, 0.5, 0.25, "indicator", {"f"}, {{"oscillation", 1e-300}, {"jumps", 3}}});
  s.effectivity = 1.1;
  s.effectivity_published = 7.3;
  s.kkt.infeasible = 1e-17;
  s.kkt.equilibrium = 2e-17;
  s.active_points = 18;
  s.time.linear = 0.1;
  s.memory_mb = 123.4;
  s.versions = {{"thixis", "0.1.0"}, {"kokkos", "3.4.1"}};
  const Json json = written(s);
  EXPECT_EQ(json["verdict"], s.verdict);
  EXPECT_EQ(json["exit_code"], 4);
  EXPECT_EQ(json["model"], "membranes");
  EXPECT_EQ(json["case"], "disk");
  EXPECT_EQ(json["method"], "hho");
  EXPECT_EQ(json["degree"], 3);
  EXPECT_EQ(json["ranks"], 2);
  EXPECT_EQ(json["threads"], 5);
  EXPECT_EQ(json["cells"], 5000000000ll);
  EXPECT_EQ(json["unknowns"], (Json{{"all", 11}, {"global", 12}}));
  EXPECT_EQ(json["nonzeros"], 13);
  EXPECT_EQ(json["newton_iterations"], 14);
  EXPECT_EQ(json["newton_finest"], 15);
  EXPECT_EQ(json["linear_iterations"], 16);
  EXPECT_EQ(json["energy_error"], 1.0 / 3);
  EXPECT_EQ(json["energy_norm"], 17);
  EXPECT_EQ(json["estimate"],
            (Json{{"total", 1.5}, {"discretization", 1.25}, {"linearization", 0.125}, {"algebraic", 0.0625}, {"promise", "guaranteed"}}));
  EXPECT_EQ(keys(json["estimate_published"]), (std::vector<std::string>{"total", "discretization", "linearization", "algebraic", "promise",
                                                                        "doubts", "oscillation", "jumps"}));
  EXPECT_EQ(json["estimate_published"]["oscillation"], 1e-300);
  EXPECT_EQ(json["effectivity"], 1.1);
  EXPECT_EQ(json["effectivity_published"], 7.3);
  EXPECT_EQ(json["kkt"]["infeasible"], 1e-17);
  EXPECT_TRUE(json["kkt"]["negative"].is_null());
  EXPECT_EQ(json["kkt"]["equilibrium"], 2e-17);
  EXPECT_EQ(json["active_points"], 18);
  EXPECT_EQ(json["time"]["linear"], 0.1);
  EXPECT_EQ(json["memory_mb"], 123.4);
  EXPECT_EQ(json["versions"], (Json{{"thixis", "0.1.0"}, {"kokkos", "3.4.1"}}));
}

TEST(summary, of_a_model_in_time_has_its_keys_in_their_places) {
  const std::vector<std::string> stationary = keys(written(Summary()));
  Summary s;
  s.in_time.emplace(SummaryTime{100, 3, 5e5});
  s.of_model = {{"mass_balance", {}, {{"water", 1e-15}, {"hydrogen", 3e-12}}}, {"front", 12.5, {}}};
  const Json json = written(s);
  EXPECT_EQ(json["steps"], 100);
  EXPECT_EQ(json["retries"], 3);
  EXPECT_EQ(json["time_end"], 5e5);
  EXPECT_EQ(json["mass_balance"], (Json{{"water", 1e-15}, {"hydrogen", 3e-12}}));
  EXPECT_EQ(json["front"], 12.5);

  const std::vector<std::string> all = keys(json);
  const auto place = [&](const char* key) { return std::find(all.begin(), all.end(), key) - all.begin(); };
  EXPECT_EQ(place("steps"), place("linear_iterations") + 1);
  EXPECT_EQ(place("time_end"), place("energy_error") - 1);
  EXPECT_EQ(all.back(), "front");
  EXPECT_EQ(all.size(), stationary.size() + 5);
  s.of_model.back().value.reset();
  EXPECT_TRUE(written(s)["front"].is_null()) << "no gas";
}

TEST(summary, has_null_for_numbers_that_are_not_finite) {
  Summary s;
  s.energy_error = NAN;
  s.effectivity = INFINITY;
  s.estimate.emplace(SummaryEstimate{NAN, 1, -INFINITY, 1, "indicator", {}, {}});
  s.kkt.negative = NAN;
  s.time.mesh = NAN;
  s.memory_mb = NAN;
  s.of_model = {{"depth", NAN, {}}};
  const Json json = written(s);
  EXPECT_TRUE(json["energy_error"].is_null());
  EXPECT_TRUE(json["effectivity"].is_null());
  EXPECT_TRUE(json["estimate"]["total"].is_null());
  EXPECT_EQ(json["estimate"]["discretization"], 1);
  EXPECT_TRUE(json["estimate"]["linearization"].is_null());
  EXPECT_TRUE(json["kkt"]["negative"].is_null());
  EXPECT_TRUE(json["time"]["mesh"].is_null());
  EXPECT_TRUE(json["memory_mb"].is_null());
  EXPECT_TRUE(json["depth"].is_null());
}

TEST(summary, has_keys_of_the_model_which_repeat_no_other) {
  Summary s;
  s.of_model = {{"probes", {}, {{"left", 1e-12}, {"right", 2e-12}}}, {"depth", 0.25, {}}};
  const Json json = written(s);
  EXPECT_EQ(json["depth"], 0.25);
  EXPECT_EQ(json["probes"]["right"], 2e-12);
  s.of_model.push_back({"time", 1, {}});
  EXPECT_EQ(sentence_of(core::ExitCode::internal, [&] { written(s); }), "The summary has a key 'time' already.");
  s.of_model.back().key = "cells";
  EXPECT_EQ(sentence_of(core::ExitCode::internal, [&] { written(s); }), "The summary has a key 'cells' already.");
}

TEST(summary, that_is_disabled_touches_no_file) {
  const core::Comm comm;
  const std::string folder = scratch("summary_disabled");
  Summary s;
  s.enabled = false;
  s.write(folder + "/summary.json", comm);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(summary, that_can_not_be_written_is_an_error_on_all_ranks_and_spares_the_old_one) {
  const core::Comm comm;
  const std::string folder = scratch("summary_errors"), path = folder + "/summary.json";
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { Summary().write(folder + "/none/summary.json", comm); }),
            "The file '" + folder + "/none/summary.json' can not be written: No such file or directory.");
  Summary().write(path, comm);
  const std::string before = content(path);
  comm.barrier();
  const FullDisk full(20);
  EXPECT_EQ(sentence_of(core::ExitCode::input_output, [&] { Summary().write(path, comm); }),
            "The file '" + path + "' can not be written: File too large.");
  EXPECT_EQ(content(path), before);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

}  // namespace thixis::output
