#include <gtest/gtest.h>

#include "estimated_model.hpp"
#include "judge/verdict_at_rest.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/drive/stationary.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::drive::test {
namespace {

struct Solved {
  explicit Solved(const RunParams& given, int good_levels = 100)
      : params(given), model(params), hierarchy(mesh::build(params.mesh, core::Comm(), ".")) {
    model.good_levels = good_levels;
    Observer observer;
    observer.level = [this](const mesh::Mesh& mesh, int level, const models::Sizes& sizes) {
      solved.push_back(level), unknowns.push_back(sizes.unknowns_all), cells.push_back(mesh.global_cells);
    };
    observer.level_end = [this](const Progress& at) { ends.push_back(at); };
    observer.step = [this](const Progress& at, const complementarity::NewtonRecord&) { steps.push_back(at); };
    outcome = solve_stationary(model, hierarchy, params, observer);
  }
  const RunParams params;
  EstimatedModel model;
  mesh::Hierarchy hierarchy;
  std::vector<int> solved;
  std::vector<GlobalIndex> unknowns, cells;
  std::vector<Progress> ends, steps;
  Outcome outcome;
};

RunParams with_target(double target) {
  RunParams params = smooth_contact();
  params.stopping.target = target;
  return params;
}

RunParams with_limits(int levels, long long unknowns = 1000000) {
  RunParams params = smooth_contact();
  params.adapt.emplace();
  params.adapt->max_levels = levels, params.adapt->max_unknowns = unknowns;
  return params;
}

double first_bound() {
  static const double bound = Solved(with_limits(0)).outcome.estimate->total;
  return bound;
}

TEST(Adaptive, refines_until_the_bound_meets_the_target_and_no_further) {
  const double target = 0.4 * first_bound();
  const Solved run(with_target(target));
  EXPECT_TRUE(run.outcome.solved);
  ASSERT_GE(run.ends.size(), 3u);
  for (std::size_t level = 0; level < run.ends.size(); ++level)
    EXPECT_EQ(run.ends[level].estimate->total <= target, level + 1 == run.ends.size());
  EXPECT_LE(run.outcome.energy_error.value(), run.outcome.estimate->total);
  EXPECT_EQ(judge(run.params, run.outcome).code, core::ExitCode::done);
  const std::string sentence = judge(run.params, run.outcome).sentence;
  EXPECT_NE(sentence.find("energy error at most"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("(guaranteed)"), std::string::npos) << sentence;
}

/// Errors are integrals by a rule, of differences of the exact solution.
TEST(Verdict, says_where_the_error_contradicts_the_bound) {
  using complementarity::Promise;
  const auto says = [](Promise promise, std::optional<double> error) {
    complementarity::Estimate eta;
    eta.total = 0.5, eta.promise = promise;
    return contradiction(eta, error, 3);
  };
  EXPECT_NE(says(Promise::guaranteed, 0.66).find("the exact solution does not fit the data"), std::string::npos);
  EXPECT_NE(says(Promise::up_to_quadrature, 0.66).find("quadrature does not see all of the data"), std::string::npos);
  EXPECT_EQ(says(Promise::indicator, 0.66), "");
  for (const Promise promise : {Promise::guaranteed, Promise::up_to_quadrature, Promise::indicator}) {
    EXPECT_EQ(says(promise, 0.5 + 1e-9), "");
    EXPECT_EQ(says(promise, 0.4), "");
    EXPECT_EQ(says(promise, std::nullopt), "");
  }
  EXPECT_EQ(contradiction({}, 1e-10, 1), "") << "differences";
}

TEST(Adaptive, solves_the_mesh_of_the_deck_only_if_that_is_good_enough) {
  const Solved run(with_target(2 * first_bound()));
  EXPECT_EQ(run.solved, std::vector<int>{1});
  EXPECT_EQ(run.outcome.mesh, &run.hierarchy.finest());
}

TEST(Adaptive, begins_cold_on_the_first_mesh_only) {
  RunParams params = with_limits(3);
  const Solved cold(params);
  EXPECT_EQ(cold.solved, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(cold.model.nested, (std::vector<bool>{false, true, true, true}));
  params.newton.start = complementarity::Start::nested;
  const Solved nested(params);
  EXPECT_EQ(nested.solved, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(nested.cells.back(), cold.cells.back());
}

TEST(Adaptive, without_a_target_it_ends_at_the_limit_of_levels_and_all_is_well) {
  const Solved run(with_limits(2));
  EXPECT_EQ(run.solved.size(), 3u);
  EXPECT_EQ(run.outcome.refinement_ended, "adapt/max levels = 2");
  EXPECT_EQ(judge(run.params, run.outcome).code, core::ExitCode::done);
  for (std::size_t level = 1; level < run.cells.size(); ++level) {
    EXPECT_GT(run.cells[level], run.cells[level - 1]);
    EXPECT_LT(run.cells[level], 4 * run.cells[level - 1]);
  }
}

TEST(Adaptive, uniform_marking_cuts_all_cells) {
  RunParams params = with_limits(2);
  params.adapt->marking = Marking::uniform;
  const Solved run(params);
  for (std::size_t level = 1; level < run.cells.size(); ++level) EXPECT_GE(run.cells[level], 2 * run.cells[level - 1]);
}

TEST(Adaptive, solves_no_mesh_beyond_the_limit_of_unknowns) {
  const Solved all(with_limits(4));
  const Solved run(with_limits(30, all.unknowns[3] - 1));
  EXPECT_EQ(run.solved.size(), 3u);
  EXPECT_EQ(run.outcome.discretization->sizes().unknowns_all, all.unknowns[2]);
  EXPECT_NE(run.outcome.refinement_ended.find("adapt/max unknowns"), std::string::npos);
  EXPECT_EQ(judge(run.params, run.outcome).code, core::ExitCode::done);
  EXPECT_THROW(Solved(with_limits(30, all.unknowns[0] - 1)), core::InputError);
}

TEST(Adaptive, a_target_behind_a_limit_is_missed_with_the_bound_that_was_reached) {
  RunParams params = with_limits(1);
  params.stopping.target = 1e-6;
  const Solved run(params);
  const Verdict verdict = judge(run.params, run.outcome);
  EXPECT_EQ(verdict.code, core::ExitCode::target_missed);
  char bound[32];
  std::snprintf(bound, sizeof bound, "%.4e", run.outcome.estimate->total);
  EXPECT_EQ(verdict.sentence, std::string("target missed: energy error at most ") + bound +
                                  " (guaranteed), not 1e-06; refinement ended by adapt/max levels = 1; allow more of them, take a larger "
                                  "adapt/theta or a higher method/degree, or begin with a finer mesh.");
}

TEST(Adaptive, the_verdict_says_what_the_bound_promises_and_judges_by_it_whatever_that_is) {
  using complementarity::Promise;
  Solved run(with_target(2 * first_bound()));
  for (const Promise promise : {Promise::guaranteed, Promise::up_to_quadrature, Promise::indicator}) {
    run.outcome.estimate->promise = promise;
    const Verdict verdict = judge(run.params, run.outcome);
    EXPECT_EQ(verdict.code, core::ExitCode::done);
    EXPECT_NE(verdict.sentence.find(std::string(" (") + to_text(promise) + "), as asked for by stopping/target"), std::string::npos);
  }
}

TEST(Adaptive, keeps_the_solution_with_the_smallest_bound_where_the_target_is_missed) {
  RunParams params = with_limits(3);
  params.stopping.target = 1e-6;
  const Solved whole(params), run(params, 2);
  EXPECT_EQ(run.outcome.at.level, 2);
  EXPECT_EQ(run.outcome.mesh, &run.hierarchy.levels[2]);
  EXPECT_EQ(run.outcome.estimate->total, run.ends[1].estimate->total);
  EXPECT_EQ(run.outcome.energy_error, whole.ends[1].energy_error);
  EXPECT_TRUE(run.outcome.kkt->holds(run.outcome.kkt_tolerance));
  EXPECT_EQ(run.outcome.cell_estimates.discretization.size(), static_cast<std::size_t>(run.outcome.mesh->owned_cells));
}

TEST(Adaptive, the_exact_rule_asks_for_one_estimate_at_the_end_of_each_level) {
  const Solved run(with_limits(2));
  EXPECT_EQ(run.model.estimates, 3);
  for (const Progress& step : run.steps) EXPECT_FALSE(step.estimate);
  for (const Progress& end : run.ends) EXPECT_TRUE(end.estimate && end.energy_error);
}

TEST(Adaptive, what_newton_has_estimated_is_not_estimated_again) {
  RunParams params = with_limits(2);
  params.stopping.rule = complementarity::StoppingRule::adaptive;
  const Solved run(params);
  EXPECT_TRUE(run.outcome.solved) << run.outcome.finest.why;
  EXPECT_EQ(run.model.estimates, static_cast<int>(run.steps.size()));
  EXPECT_EQ(run.ends.back().estimate->total, run.steps.back().estimate->total);
}

TEST(Adaptive, a_run_that_wants_no_estimate_computes_none) {
  const Solved run(smooth_contact());
  EXPECT_EQ(run.model.estimates, 0);
  EXPECT_FALSE(run.outcome.estimate);
  EXPECT_TRUE(run.ends.empty());
  EXPECT_TRUE(run.outcome.energy_error);
}

TEST(Adaptive, the_published_bound_is_for_those_who_ask) {
  RunParams params = smooth_contact();
  params.stopping.estimate = true;
  EXPECT_TRUE(Solved(params).outcome.published);
  EXPECT_FALSE(Solved(with_limits(0)).outcome.published);
}

TEST(Adaptive, what_newton_can_not_solve_is_not_refined) {
  RunParams params = with_target(1e-6);
  params.newton.max_iterations = 1;
  const Solved run(params);
  EXPECT_FALSE(run.outcome.solved);
  EXPECT_EQ(run.solved.size(), 1u);
  EXPECT_TRUE(run.outcome.estimate) << "a bound holds at any iterate";
  EXPECT_EQ(judge(run.params, run.outcome).code, core::ExitCode::not_converged);
}

TEST(Adaptive, no_iterations_only_count) {
  RunParams params = with_target(1e-6);
  params.newton.max_iterations = 0;
  const Solved run(params);
  EXPECT_EQ(run.model.estimates, 0);
  EXPECT_EQ(judge(run.params, run.outcome).code, core::ExitCode::done);
}

}  // namespace
}  // namespace thixis::drive::test
