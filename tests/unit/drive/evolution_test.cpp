#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "falling.hpp"
#include "registry.hpp"
#include "restart/checkpoint.hpp"
#include "restart/stored.hpp"
#include "steps/step_control.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/drive/evolve.hpp"
#include "thixis/membranes/params.hpp"

namespace thixis::drive {
namespace {

using algebra::Vector;

RunParams half_a_unit(double step) {
  RunParams params = catalogue().defaults();
  membranes::of(params.scene).data.emplace();
  params.output.directory = "results";
  params.time = TimeParams{};
  params.time->step = step;
  params.time->end = 0.5;
  return params;
}

/// The ends of all steps.
std::vector<double> times(const test::Falling& scene, const RunParams& params, EvolutionOutcome* outcome = nullptr) {
  const auto evolution = test::falling(scene, core::Comm());
  std::vector<double> ends;
  EvolutionObserver observer;
  observer.step = [&](const StepRecord& record, const models::Evolution&, const Vector&, const complementarity::ActiveSet&) {
    ends.push_back(record.at.time);
  };
  EvolutionOutcome found = evolve(*evolution, params, observer);
  if (outcome != nullptr) *outcome = std::move(found);
  return ends;
}

}  // namespace

TEST(Steps, end_at_multiples_and_at_the_times_asked_for) {
  RunParams params = half_a_unit(0.1);
  params.time->also = {0.15, 0.3};
  EvolutionOutcome outcome;
  const auto ends = times({}, params, &outcome);
  const std::vector<double> expected = {0, 0.1, 0.15, 0.2, 3 * 0.1, 0.4, 0.5};
  ASSERT_EQ(ends.size(), expected.size());
  for (std::size_t i = 0; i < ends.size(); ++i) EXPECT_NEAR(ends[i], expected[i], 1e-15);
  EXPECT_EQ(ends.back(), 0.5);
  EXPECT_TRUE(outcome.solved);
  EXPECT_EQ(outcome.at.step, 6);
  EXPECT_EQ(outcome.at.retries, 0);
  EXPECT_TRUE(outcome.kkt->holds(1e-12));
}

TEST(Steps, that_fail_are_cut_and_grow_again) {
  test::Falling scene;
  scene.longest_step = 0.03;
  std::vector<std::string> reasons;
  const auto evolution = test::falling(scene, core::Comm());
  EvolutionObserver observer;
  double longest = 0;
  observer.retry = [&](const TimePosition&, double, const std::string& why, double) { reasons.push_back(why); };
  observer.step = [&](const StepRecord& record, const models::Evolution&, const Vector&, const complementarity::ActiveSet&) {
    longest = std::max(longest, record.length);
  };
  const auto outcome = evolve(*evolution, half_a_unit(0.1), observer);
  EXPECT_TRUE(outcome.solved);
  EXPECT_EQ(outcome.at.time, 0.5);
  EXPECT_EQ(static_cast<int>(reasons.size()), outcome.at.retries);
  EXPECT_GE(outcome.at.retries, 2);
  EXPECT_LE(longest, 0.03);
  EXPECT_NE(reasons.front().find("the step is too long"), std::string::npos) << reasons.front();
}

TEST(Steps, begin_again_from_the_state_before_where_a_prediction_leads_nowhere) {
  test::Falling scene;
  EvolutionOutcome plain, misled;
  const auto ends = times(scene, half_a_unit(0.1), &plain);
  scene.misleading = true;
  EXPECT_EQ(times(scene, half_a_unit(0.1), &misled), ends);
  EXPECT_TRUE(misled.solved);
  EXPECT_EQ(misled.at.retries, misled.at.step);
  Vector difference(*misled.X, Teuchos::Copy);
  difference.update(-1, *plain.X, 1);
  EXPECT_EQ(difference.normInf(), 0);
}

TEST(Steps, that_would_be_too_short_end_the_run) {
  test::Falling scene;
  scene.longest_step = 0;
  RunParams params = half_a_unit(0.1);
  params.time->smallest = 0.01;
  EvolutionOutcome outcome;
  times(scene, params, &outcome);
  EXPECT_FALSE(outcome.solved);
  EXPECT_EQ(outcome.at.step, 0);
  EXPECT_EQ(outcome.at.retries, 4);  // 0.1, 0.05, 0.025, 0.0125
  EXPECT_NE(outcome.why.find("time/smallest"), std::string::npos) << outcome.why;
  EXPECT_NE(outcome.why.find("Try linear/solver = direct"), std::string::npos) << outcome.why;
  for (const double x : {outcome.X->normInf()}) EXPECT_EQ(x, 0.1);  // the last state that was good
}

TEST(Steps, follow_the_error_in_time) {
  RunParams params = half_a_unit(0.1);
  params.time->adaptive = true;
  test::Falling scene;
  scene.error_in_time = 100;  // half of that in space at length 1/200; the first attempt is far too long
  EvolutionOutcome outcome;
  const auto ends = times(scene, params, &outcome);
  EXPECT_GT(outcome.at.retries, 0);
  for (std::size_t i = 3; i + 2 < ends.size(); ++i) EXPECT_NEAR(ends[i] - ends[i - 1], 0.005, 1e-12);
  scene.error_in_time = 1e-6;  // as long as they may become
  params.time->step = 0.01;
  params.time->largest = 0.1;
  const auto few = times(scene, params);
  EXPECT_LT(few.size(), 12u);
  EXPECT_EQ(few.back(), 0.5);
}

/// Both parts of the error in one ratio, whatever the length: shorter steps are of no use, and not made for ever.
TEST(Steps, are_not_made_shorter_where_that_is_of_no_use) {
  RunParams params = half_a_unit(0.01);
  params.time->adaptive = true;
  test::Falling scene;
  scene.error_in_time = 1000;  // ratio 10 at length 0.01, and of all shorter ones
  scene.alike = 0.01;
  EvolutionOutcome outcome;
  const auto ends = times(scene, params, &outcome);
  EXPECT_TRUE(outcome.solved);
  EXPECT_EQ(outcome.at.retries, 1);
  EXPECT_LE(outcome.at.step, 55);
}

/// An error in time beside none in space: every length above time/smallest is refused, and that one is taken.
TEST(Steps, at_the_smallest_length_are_taken) {
  RunParams params = half_a_unit(0.1);
  params.time->adaptive = true;
  params.time->smallest = 0.001;
  test::Falling scene;
  scene.error_in_time = 1e9;
  EvolutionOutcome outcome;
  const auto ends = times(scene, params, &outcome);
  EXPECT_TRUE(outcome.solved);
  for (std::size_t i = 1; i + 2 < ends.size(); ++i) EXPECT_NEAR(ends[i] - ends[i - 1], 0.001, 1e-9);
}

/// However late: the last digits of the time are longer than the step.
TEST(Steps, end_at_multiples_after_millions_of_them) {
  TimeParams time;
  time.step = 0.1;
  time.end = 1e9;
  StepControl control(time);
  for (const double k : {3.0, 5e6 + 1, 1e7 + 3, 123456789.0, 9999999998.0}) {
    const double begin = k * time.step, end = control.end_of_step(begin);
    EXPECT_NEAR(end - begin, time.step, 1e-6) << k;
  }
}

TEST(Steps, that_are_refused_let_the_run_end) {
  test::Falling scene;
  scene.longest_step = 0.01;
  const auto evolution = test::falling(scene, core::Comm());
  EvolutionObserver observer;
  int asked = 0;
  double data_time = -1;
  observer.stop = [&](const TimePosition& at, double next, const models::Evolution& known, const Vector& X) -> std::string {
    if (++asked < 3) return "";
    EXPECT_EQ(at.step, 0);
    EXPECT_NEAR(next, 0.1 / 8, 1e-15);
    data_time = known.save(X).attributes.at("data_time");
    return "told to end";
  };
  const auto outcome = evolve(*evolution, half_a_unit(0.1), observer);
  EXPECT_EQ(outcome.stopped, "told to end");
  EXPECT_FALSE(outcome.solved);
  EXPECT_EQ(outcome.at.retries, 3);
  EXPECT_EQ(data_time, 0);  // of the state that is kept
}

TEST(Steps, before_a_mistake_in_the_data_are_kept) {
  test::Falling scene;
  scene.wrong_from = 0.35;
  const auto evolution = test::falling(scene, core::Comm());
  const auto outcome = evolve(*evolution, half_a_unit(0.1), {});
  EXPECT_FALSE(outcome.solved);
  EXPECT_EQ(outcome.mistake, "scene: the data end here.");
  EXPECT_EQ(outcome.at.step, 3);
  EXPECT_NEAR(outcome.at.time, 0.3, 1e-15);
  EXPECT_NEAR(evolution->save(*outcome.X).attributes.at("data_time"), 0.3, 1e-15);
  scene.wrong_from = 0.05;  // nothing is lost
  EXPECT_THROW(evolve(*test::falling(scene, core::Comm()), half_a_unit(0.1), {}), core::InputError);
}

TEST(Steps, have_ends_that_are_known_ahead) {
  TimeParams time;
  time.step = 0.1;
  time.end = 0.45;
  time.also = {0.25};
  const auto is = [](const std::vector<double>& found, const std::vector<double>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-15);
  };
  is(known_times(time, {}, 0), {0.1, 0.2, 0.25, 0.3, 0.4, 0.45});
  is(known_times(time, {0.05}, 0.2), {0.25, 3 * 0.1, 0.4, 0.45});
  time.adaptive = true;
  is(known_times(time, {}, 0), {0.25, 0.45});
  time.adaptive = false;
  time.end = 1e6;
  const auto many = known_times(time, {}, 0);
  EXPECT_LE(many.size(), 102u);
  StepControl control(time);
  for (std::size_t i = 2; i + 1 < many.size(); ++i) EXPECT_EQ(control.end_of_step(many[i] - 0.05), many[i]);
}

TEST(Steps, go_on_from_a_checkpoint_bit_for_bit) {
  const core::Comm comm;
  const auto folder = std::filesystem::temp_directory_path() / ("thixis_evolution_" + std::to_string(comm.size()));
  comm.on_root([&] { std::filesystem::create_directories(folder); });
  const std::string path = (folder / "checkpoint.h5").string();
  test::Falling scene;
  scene.longest_step = 0.03;
  const RunParams params = half_a_unit(0.1);
  const auto whole = test::falling(scene, comm);
  const CheckpointFile checkpoint(path, params, core::Deck::from_text("<ParameterList name=\"thixis\"/>", "deck.xml", folder.string()));
  EvolutionObserver observer;
  observer.stop = [&](const TimePosition& at, double next, const models::Evolution& evolution, const Vector& X) {
    if (at.step == 7) checkpoint.write(evolution, X, 0, stored_by(at, next, {11, 8, 2, 5, 1.5}));
    return std::string();
  };
  const auto expected = evolve(*whole, params, observer);

  const auto stored = output::read_checkpoint(path, comm);
  EXPECT_EQ(stored_evolution(stored).at.step, 7);
  EXPECT_EQ(stored_evolution(stored).written.history_rows, 11);
  EXPECT_EQ(stored_evolution(stored).written.frames, 2);
  const auto again = test::falling(scene, comm);
  const auto found = evolve(*again, params, {}, &stored);
  EXPECT_EQ(found.at.step, expected.at.step);
  EXPECT_EQ(found.at.newton_iterations, expected.at.newton_iterations);
  EXPECT_EQ(found.at.retries, expected.at.retries);
  EXPECT_EQ(*again->error_so_far(), *whole->error_so_far());
  const auto a = algebra::host_view(std::as_const(*found.X)), b = algebra::host_view(std::as_const(*expected.X));
  for (std::size_t i = 0; i < a.extent(0); ++i) EXPECT_EQ(a(i), b(i));
  comm.barrier();
  comm.on_root([&] { std::filesystem::remove_all(folder); });
}

}  // namespace thixis::drive
