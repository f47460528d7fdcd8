#include "data/cases.hpp"

#include <gtest/gtest.h>

#include "scene/sample.hpp"
#include "thixis/core/error.hpp"

namespace thixis::flow {
namespace {

using scene::Sample;

/// What the deck gives takes the place of what the case brings, one entry at a time.
TEST(FlowCase, is_changed_by_what_the_deck_gives) {
  models::SceneParams params;
  params.model = "two-phase";
  for (const models::Case& c : cases()) {
    params.case_name = c.name;
    const TwoPhaseScene scene = two_phase_scene(params);
    EXPECT_EQ(scene.name, c.name);
    EXPECT_EQ(scene.sentence, c.sentence);
    EXPECT_EQ(scene.medium.permeability, 5e-20);
    of(params).flow.emplace();
    of(params).flow->permeability = 1e-16;
    of(params).flow->capillary_law = CapillaryLaw::quadratic;
    of(params).flow->boundary["right"].kind = FlowBoundaryKind::state;
    of(params).flow->boundary["right"].S.text = "0.75";
    const TwoPhaseScene changed = two_phase_scene(params);
    EXPECT_EQ(changed.medium.permeability, 1e-16);
    EXPECT_EQ(changed.medium.porosity, 0.15);
    EXPECT_EQ(changed.capillary_law, CapillaryLaw::quadratic);
    Sample end;
    end.add(200, 20);
    EXPECT_EQ(end(changed.boundary.at("right").state.s_g)[0], 0.25);
    EXPECT_EQ(end(changed.boundary.at("right").state.P)[0], 1e6);
    EXPECT_EQ(changed.boundary.count("left"), scene.boundary.count("left"));
    of(params).flow.reset();
  }
}

TEST(FlowCase, injects_until_half_of_a_million_years) {
  models::SceneParams params;
  params.model = "two-phase";
  for (const auto& [name, rate] : {std::pair("gas injection", 5.57e-6), std::pair("gas injection 2d", 4 * 5.57e-6)}) {
    params.case_name = name;
    const FlowBoundary left = two_phase_scene(params).boundary.at("left");
    Sample points;
    points.add(0, 2);
    points.add(0, 6);
    EXPECT_EQ(points(left.hydrogen, 4.9e5)[0], rate);
    EXPECT_EQ(points(left.hydrogen, 5.1e5)[0], 0);
    EXPECT_EQ(points(left.hydrogen, 4.9e5)[1], rate > 6e-6 ? 0 : rate);
  }
}

TEST(FlowDeck, refuses_what_contradicts_itself) {
  models::SceneParams params;
  params.model = "two-phase";
  EXPECT_THROW(two_phase_scene(params), core::InputError);  // neither case nor flow
  of(params).flow.emplace();
  EXPECT_NO_THROW(two_phase_scene(params));
  of(params).flow->initial.S.text = of(params).flow->initial.s_g.text = "0.5";
  EXPECT_THROW(two_phase_scene(params), core::InputError);
  of(params).flow.emplace();
  of(params).flow->boundary["left"].hydrogen.text = "1";  // of kind no-flow
  EXPECT_THROW(two_phase_scene(params), core::InputError);
  of(params).flow.emplace();
  of(params).flow->S_lr = of(params).flow->S_gr = 0.5;
  EXPECT_THROW(two_phase_scene(params), core::InputError);
}

}  // namespace
}  // namespace thixis::flow
