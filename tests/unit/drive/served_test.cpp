#include <gtest/gtest.h>

#include "estimated_model.hpp"
#include "judge/expectations.hpp"
#include "registry.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/drive/run.hpp"
#include "thixis/membranes/params.hpp"

namespace thixis::drive::test {
namespace {

std::string refusal(const RunParams& params) {
  try {
    check_served(params);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Served, a_target_and_nothing_else_is_enough) {
  RunParams params = catalogue().defaults();
  params.scene.case_name = "smooth contact";
  params.stopping.target = 1e-3;
  EXPECT_EQ(refusal(params), "");
  EXPECT_TRUE(params.adaptive() && params.estimated());
  EXPECT_EQ(params.stopping.rule, complementarity::StoppingRule::exact);
}

TEST(Served, what_needs_the_estimate_can_not_go_without) {
  RunParams params = smooth_contact();
  params.stopping.estimate = false;
  EXPECT_EQ(refusal(params), "");
  params.stopping.target = 1e-3, params.stopping.rule = complementarity::StoppingRule::adaptive;
  params.adapt.emplace();
  for (const char* path : {"stopping/rule: ", "stopping/target: ", "adapt: "})
    EXPECT_NE(refusal(params).find(std::string(path)), std::string::npos) << refusal(params);
}

TEST(Served, an_effectivity_needs_the_estimate_and_the_exact_solution) {
  RunParams params = smooth_contact();
  params.expect.effectivity_between = {1, 2};
  EXPECT_NE(refusal(params).find("expect/effectivity between: nobody estimates the error"), std::string::npos);
  params.stopping.estimate = true;
  EXPECT_EQ(refusal(params), "");
  params.scene.case_name.reset();
  membranes::of(params.scene).data.emplace();
  membranes::of(params.scene).data->g1.text = "1", membranes::of(params.scene).data->g2.text = "0";
  EXPECT_NE(refusal(params).find("expect/effectivity between: without the exact solution"), std::string::npos) << refusal(params);
}

TEST(Served, fields_of_the_estimate_need_the_estimate) {
  RunParams params = smooth_contact();
  params.output.fields = "u1, eta_disc";
  EXPECT_NE(refusal(params).find("output/fields: there is no 'eta_disc'"), std::string::npos);
  params.stopping.estimate = true;
  EXPECT_EQ(refusal(params), "");
  EXPECT_EQ(params.output.model_names(), std::vector<std::string>{"u1"});
  EXPECT_EQ(params.output.estimate_names(), std::vector<std::string>{"eta_disc"});
}

TEST(Expectations, judge_bound_and_effectivity) {
  RunParams params = smooth_contact();
  params.newton.max_iterations = 0;
  EstimatedModel model(params);
  mesh::Hierarchy hierarchy = mesh::build(params.mesh, core::Comm(), ".");
  Outcome outcome = solve_stationary(model, hierarchy, params, {});
  outcome.not_wanted = false, outcome.solved = true;
  ExpectParams expect;
  expect.effectivity_between = {1, 2}, expect.bound_at_most = 0.1;
  EXPECT_EQ(missed(expect, found(outcome)).size(), 2u) << "neither is known";
  outcome.energy_error = 0.05, outcome.estimate.emplace();
  outcome.estimate->total = 0.09;
  EXPECT_TRUE(missed(expect, found(outcome)).empty());
  outcome.estimate->total = 0.11;
  EXPECT_EQ(missed(expect, found(outcome)),
            (std::vector<std::string>{"bound 0.11 is above 0.1", "effectivity 2.2 is not between 1 and 2"}));
  using complementarity::Promise;
  for (const Promise promise : {Promise::guaranteed, Promise::up_to_quadrature, Promise::indicator}) {
    outcome.estimate->promise = promise, outcome.estimate->total = 0.09;
    expect.promise = Promise::up_to_quadrature;
    EXPECT_EQ(missed(expect, found(outcome)).empty(), promise != Promise::indicator) << to_text(promise);
  }
  EXPECT_EQ(missed(expect, found(outcome)), std::vector<std::string>{"the bound is 'indicator', not 'up to quadrature of the data'"});
  expect.promise.reset();
  outcome.estimate->total = 0.04;
  EXPECT_EQ(missed(expect, found(outcome)), std::vector<std::string>{"effectivity 0.8 is not between 1 and 2"});
}

}  // namespace
}  // namespace thixis::drive::test
