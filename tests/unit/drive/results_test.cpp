#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "estimated_model.hpp"
#include "output/scratch.hpp"
#include "thixis/drive/run.hpp"

namespace thixis::drive::test {
namespace {

/// The files of a run; the deck is empty, what is run are the parameters.
struct Files {
  Files(RunParams params, const std::string& folder, const EstimatedModel* of = nullptr) : directory(output::scratch(folder)) {
    params.output.directory = directory;
    const EstimatedModel own(params);
    code = run(params, of ? *of : own, core::Deck::from_text("<ParameterList name=\"thixis\"/>", "test.xml"), core::Comm(), {});
    summary = nlohmann::json::parse(output::content(directory + "/summary.json"));
  }
  std::string text(const char* file) const { return output::content(directory + "/" + file); }
  /// The rows of history.csv, cell by cell.
  std::vector<std::map<std::string, std::string>> history() const {
    const auto cells = [](const std::string& line) {
      std::vector<std::string> found;
      std::istringstream in(line + ",");
      for (std::string cell; std::getline(in, cell, ',');) found.push_back(cell);
      return found;
    };
    std::istringstream in(text("history.csv"));
    std::string line;
    std::getline(in, line);
    const auto names = cells(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(in, line)) {
      const auto values = cells(line);
      rows.emplace_back();
      for (std::size_t i = 0; i < names.size(); ++i) rows.back()[names[i]] = values[i];
    }
    return rows;
  }
  std::string directory;
  core::ExitCode code;
  nlohmann::json summary;
};

RunParams estimated() {
  RunParams params = smooth_contact();
  params.stopping.estimate = true;
  return params;
}

TEST(Results, the_summary_holds_both_bounds_and_their_effectivity) {
  const Files files(estimated(), "summary");
  EXPECT_EQ(files.code, core::ExitCode::done);
  EXPECT_GE(files.summary["effectivity"].get<double>(), 1.5 - 1e-12);
  EXPECT_NEAR(files.summary["effectivity_published"].get<double>(), 10, 1e-12);
  EXPECT_EQ(files.summary["estimate_published"]["residual"], files.summary["estimate_published"]["total"]);
  EXPECT_LE(files.summary["estimate"]["discretization"].get<double>(), files.summary["estimate"]["total"].get<double>());
  EXPECT_NE(files.summary["verdict"].get<std::string>().find("energy error at most"), std::string::npos);
}

TEST(Results, without_an_estimate_nothing_speaks_of_it) {
  const Files files(smooth_contact(), "without");
  for (const char* key : {"estimate", "effectivity", "estimate_published", "effectivity_published"})
    EXPECT_TRUE(files.summary[key].is_null()) << key;
  EXPECT_EQ(files.text("log.txt").find("eta_disc"), std::string::npos);
  EXPECT_EQ(files.text("fields.xdmf").find("eta_disc"), std::string::npos);
  for (auto row : files.history()) EXPECT_TRUE(row["eta_total"].empty());
}

TEST(Results, the_history_has_a_row_for_the_end_of_each_level) {
  RunParams params = smooth_contact();
  params.adapt.emplace();
  params.adapt->max_levels = 2;
  const Files files(params, "levels");
  int ends = 0;
  for (auto row : files.history()) {
    EXPECT_EQ(row["eta_total"].empty(), !row["newton"].empty());
    if (!row["newton"].empty()) continue;
    EXPECT_EQ(row["level"], std::to_string(1 + ends++));
    EXPECT_FALSE(row["energy_error"].empty());
    EXPECT_LE(std::stod(row["energy_error"]), std::stod(row["eta_total"]));
  }
  EXPECT_EQ(ends, 3);
  EXPECT_NE(files.text("log.txt").find("eta_disc"), std::string::npos);
}

TEST(Results, who_asks_for_the_estimate_sees_it_at_every_step_and_look) {
  RunParams params = estimated();
  params.linear.solver = algebra::SolverKind::gmres;
  params.linear.check_every = 2;
  const Files files(params, "curves");
  int looks = 0;
  for (auto row : files.history()) {
    const bool start = row["linear"] == "0" && row["active"].empty();
    EXPECT_EQ(row["eta_alg"].empty(), start) << row["newton"] << " " << row["linear"];
    looks += row["active"].empty() && !row["linear"].empty();
  }
  EXPECT_GT(looks, 0);
}

TEST(Results, cell_fields_of_the_estimate_are_shown_if_asked_for) {
  const auto shown = [](const std::string& fields, const char* folder) {
    RunParams params = estimated();
    params.output.fields = fields;
    return Files(params, folder).text("fields.xdmf");
  };
  const std::string all = shown("all", "fields_all"), one = shown("eta_lin", "fields_one"), u = shown("u1", "fields_u");
  for (const char* name : {"u1", "eta_disc", "eta_lin", "eta_alg"}) EXPECT_NE(all.find(name), std::string::npos) << name;
  EXPECT_NE(one.find("eta_lin"), std::string::npos);
  EXPECT_EQ(one.find("eta_disc"), std::string::npos);
  EXPECT_EQ(one.find("u1"), std::string::npos);
  EXPECT_EQ(u.find("eta"), std::string::npos);
}

TEST(Results, pieces_of_a_cell_repeat_its_value) {
  RunParams params = estimated();
  params.method.degree = 3;
  EXPECT_EQ(Files(params, "pieces").code, core::ExitCode::done);
}

}  // namespace
}  // namespace thixis::drive::test
