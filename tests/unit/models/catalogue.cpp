#include "thixis/models/catalogue.hpp"

#include <gtest/gtest.h>

#include "thixis/core/deck.hpp"
#include "thixis/core/error.hpp"

namespace thixis::models {
namespace {

/// What the model `ball` has in the block `scene` for itself.
struct Ball {
  double radius = 1;
  static const core::Schema<Ball>& schema() {
    static const auto s = core::Schema<Ball>("scene", "A ball.").parameter("radius", &Ball::radius, core::above(0), "Its radius.");
    return s;
  }
};

struct Nothing final : Model {
  std::string name() const override { return "nothing"; }
  std::string case_name() const override { return ""; }
  std::vector<std::string> point_fields() const override { return {}; }
};

method::Method named(const std::string& name, std::vector<std::string> uses) {
  method::Method method;
  method.name = name;
  method.title = "the method " + name;
  method.uses = std::move(uses);
  return method;
}

Entry model(const std::string& name, bool in_time, std::vector<std::string> uses, std::vector<Case> cases) {
  Entry entry;
  entry.name = name;
  entry.title = "a " + name;
  entry.in_time = in_time;
  entry.uses = std::move(uses);
  entry.cases = std::move(cases);
  entry.accepts = [](const method::Method& method) { return method.name == "fine"; };
  entry.examine = [](const SceneParams& scene, const scene::Report& report) {
    if (!scene.case_name) report("", "give a case.");
  };
  entry.make = [](const RunParams&, const method::Method&) { return std::make_unique<Nothing>(); };
  entry.begin = [](RunParams& params) {
    if (!params.scene.case_name) params.scene.case_name = "small";
  };
  return entry;
}

Family family() {
  Family family;
  family.models = {model("ball", false, {"scene/radius", "adapt"}, {{"small", "A small one."}}),
                   model("wave", true, {"time/unit"}, {{"long", "A long one."}})};
  family.scene = [](core::Schema<SceneParams>& block) { block.with(&SceneParams::own, Ball::schema()); };
  return family;
}

class Catalogued : public ::testing::Test {
 protected:
  const Catalogue catalogue_{{named("fine", {"method/degree"}), named("coarse", {})}, {family()}};

  RunParams read(const std::vector<std::string>& entries) const {
    core::Deck deck = core::Deck::from_text(R"(<ParameterList name="thixis"/>)", "d.xml");
    for (const auto& entry : entries) deck.set(entry);
    const RunParams params = deck.parse(catalogue_.schema());
    core::check_used(deck, catalogue_.uses(), params);
    return params;
  }
  std::string refusal(const std::vector<std::string>& entries) const {
    try {
      catalogue_.make(read(entries));
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  }
};

}  // namespace

TEST_F(Catalogued, what_a_package_adds_to_a_block_is_read_from_it_and_written_with_it) {
  const RunParams params = read({"scene/model=ball", "scene/case=small", "scene/radius=3"});
  EXPECT_EQ(params.scene.own.get<Ball>().radius, 3);
  EXPECT_EQ(params.method.name, "fine") << "the first one is the default";
  const std::string deck = params.as_deck();
  EXPECT_NE(deck.find(R"(<Parameter name="radius" type="double" value="3)"), std::string::npos) << deck;
  EXPECT_EQ(core::Deck::from_text(deck, "again.xml").parse(catalogue_.schema()).scene.own.get<Ball>().radius, 3);
  EXPECT_NE(refusal({"scene/model=ball", "scene/case=small", "scene/radius=-1"}).find("scene/radius: must be above 0"), std::string::npos);
}

TEST_F(Catalogued, what_one_of_them_uses_is_an_error_with_the_others) {
  EXPECT_EQ(refusal({"scene/model=wave", "scene/case=long", "time/step=1", "time/end=2", "scene/radius=3"}),
            "--set scene/radius=3: scene/radius: this is used only with scene/model = ball; leave it out, or write scene/model = ball.");
  EXPECT_EQ(refusal({"scene/model=ball", "scene/case=small", "method/name=coarse", "method/degree=2"}),
            "--set method/degree=2: method/degree: this is used only with method/name = fine; leave it out, or write method/name = fine.");
  EXPECT_EQ(refusal({"scene/model=ball", "scene/case=small", "time/step=1", "time/end=2", "time/unit=year"}),
            "--set time/step=1: time: the scene is stationary; drop this block, or write scene/model = wave.");
}

TEST_F(Catalogued, names_are_those_of_its_own_methods_and_models) {
  EXPECT_NE(refusal({"scene/model=bell", "scene/case=small"}).find("Did you mean 'ball'?"), std::string::npos);
  EXPECT_NE(refusal({"scene/model=ball", "scene/case=small", "method/name=hho"}).find("Write one of fine, coarse"), std::string::npos);
  EXPECT_EQ(refusal({"scene/model=ball", "scene/case=long"}),
            "--set scene/case=long: scene/case: 'long' is a case of another model; write model = 'wave' or take one of its own.");
  EXPECT_THROW(catalogue_.method("medium"), core::InputError);
}

TEST_F(Catalogued, a_method_that_a_model_does_not_accept_is_refused) {
  EXPECT_EQ(refusal({"scene/model=ball", "scene/case=small", "method/name=coarse"}),
            "method/name: a ball is served by fine alone; write fine.");
  EXPECT_EQ(refusal({"scene/model=ball", "scene/case=small"}), "");
}

TEST_F(Catalogued, decks_to_start_from_have_what_their_model_needs) {
  const auto wave = catalogue_.starting("wave");
  ASSERT_TRUE(wave);
  EXPECT_TRUE(wave->time);
  EXPECT_EQ(wave->scene.case_name, "small");
  EXPECT_EQ(catalogue_.starting("long")->scene.model, "wave");
  EXPECT_FALSE(catalogue_.starting("short"));
}

}  // namespace thixis::models
