/// Runs of two-phase flow that no state can follow end without success, in a sentence, and keep what they had.
#include <gtest/gtest.h>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/drive/evolve.hpp"
#include "thixis/flow/two_phase.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::drive {
namespace {

constexpr double year = 31557600;

/// Wet rock of 20 m whose right end is held, what is drawn or brought on the left [kg/(m^3 year)], and a run of steps of 1000 years.
struct Rock {
  flow::TwoPhaseScene scene;
  RunParams params;

  Rock() {
    models::SceneParams given;
    given.model = "two-phase";
    flow::of(given).flow.emplace();
    scene = flow::two_phase_scene(given);
    auto& right = scene.boundary["right"];
    right.kind = flow::FlowBoundaryKind::state;
    right.state = scene.initial;
    params.mesh.generator = mesh::Generator::interval;
    params.mesh.lower = {0};
    params.mesh.upper = {20};
    params.mesh.cells = {20};
    params.time.emplace();
    params.time->unit = TimeUnit::year;
    params.time->step = 1000;
    params.time->end = 20000;
  }

  EvolutionOutcome run() {
    flow::TwoPhaseBoundParams bound;
    bound.adaptive = params.stopping.rule == complementarity::StoppingRule::adaptive;
    const auto model = flow::two_phase(scene, params.linear, year, bound);
    const auto evolution = model->evolve(params.mesh, core::Comm(), "", {});
    return evolve(*evolution, params, {});
  }
};

scene::FieldPtr on_the_left(double rate) {
  return scene::formula([=](double x, double) { return x < 2 ? rate : 0.0; });
}

void expect_refused(const EvolutionOutcome& outcome, const std::string& word) {
  EXPECT_FALSE(outcome.solved);
  EXPECT_NE(outcome.why.find(word), std::string::npos) << outcome.why;
}

TEST(Refused, hydrogen_is_not_drawn_from_where_there_is_none) {
  for (const auto rule :
       {complementarity::StoppingRule::exact, complementarity::StoppingRule::inexact, complementarity::StoppingRule::adaptive})
    for (const auto function : {complementarity::CFunction::min, complementarity::CFunction::fischer_burmeister}) {
      Rock rock;
      rock.scene.hydrogen_source = on_the_left(-1e-3);
      rock.params.stopping.rule = rule;
      rock.params.newton.c_function = function;
      const EvolutionOutcome outcome = rock.run();
      expect_refused(outcome, "Dissolved hydrogen would fall below zero in cell ");
      if (rule == complementarity::StoppingRule::adaptive) continue;  // which lets small violations pass
      EXPECT_EQ(outcome.at.step, 0);
    }
}

/// There is some in the beginning: the run goes on until it is used up, and says how far it came.
TEST(Refused, hydrogen_is_drawn_until_it_is_used_up) {
  Rock rock;
  rock.scene.initial.chi = scene::constant(5e-5);
  rock.scene.hydrogen_source = on_the_left(-1e-6);
  rock.params.time->smallest = 1;
  const EvolutionOutcome outcome = rock.run();
  expect_refused(outcome, "Dissolved hydrogen would fall below zero in cell 0 ");
  EXPECT_GE(outcome.at.step, 1);
  EXPECT_GT(outcome.at.time, 500);
}

}  // namespace
}  // namespace thixis::drive
