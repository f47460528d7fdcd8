/// Entries that take part under a condition only.
#include "thixis/core/uses.hpp"

#include <gtest/gtest.h>

#include "thixis/core/differences.hpp"

namespace thixis::core {
namespace {

struct Method {
  std::string name = "fem";
  double penalty = 10;
  static const Schema<Method>& schema() {
    static const auto s = Schema<Method>("method", "How.")
                              .parameter("name", &Method::name, one_of({"fem", "dg"}), "Which.")
                              .parameter("penalty", &Method::penalty, above(0), "Of the jumps.");
    return s;
  }
};
struct Linear {
  std::string solver = "gmres";
  int restart = 30;
  std::map<std::string, Method> parts;
  static const Schema<Linear>& schema() {
    static const auto s = Schema<Linear>("linear", "Solver.")
                              .parameter("solver", &Linear::solver, "Which.")
                              .parameter("restart", &Linear::restart, "Dimension.")
                              .blocks("parts", &Linear::parts, Method::schema());
    return s;
  }
};
struct Whole {
  Method method;
  Linear linear;
  static const Uses<Whole>& uses() {
    static const auto u =
        Uses<Whole>()
            .when(
                "method/penalty", [](const Whole& p) { return p.method.name == "dg"; }, "method/name = dg")
            .when(
                "linear/restart", [](const Whole& p) { return p.method.name == "fem"; }, "method/name = fem", "write nothing here.");
    return u;
  }
  static const Schema<Whole>& schema() {
    static const auto s =
        Schema<Whole>("run", "All.").block("method", &Whole::method, Method::schema()).block("linear", &Whole::linear, Linear::schema());
    return s;
  }
};

constexpr const char* text = R"(<ParameterList name="run">
  <ParameterList name="method">
    <Parameter name="penalty" type="double" value="20"/>
  </ParameterList>
  <ParameterList name="linear">
    <Parameter name="restart" type="int" value="5"/>
    <ParameterList name="parts">
      <ParameterList name="left"><Parameter name="penalty" type="double" value="1"/></ParameterList>
    </ParameterList>
  </ParameterList>
</ParameterList>
)";

std::string mistakes(const Deck& deck, bool set_alone = false) {
  try {
    check_used(deck, Whole::uses(), deck.parse(Whole::schema()), set_alone);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

}  // namespace

TEST(Uses, what_is_given_in_vain_is_refused_with_its_place) {
  EXPECT_EQ(mistakes(Deck::from_text(text, "x.xml")),
            "x.xml:3: method/penalty: this is used only with method/name = dg; leave it out, or write method/name = dg.");
}

TEST(Uses, another_block_may_decide) {
  Deck deck = Deck::from_text(text, "x.xml");
  deck.set("method/name=dg");
  EXPECT_EQ(mistakes(deck), "x.xml:6: linear/restart: write nothing here.");
}

TEST(Uses, defaults_are_never_refused) {
  EXPECT_EQ(mistakes(Deck::from_text("<ParameterList name=\"run\"></ParameterList>", "x.xml")), "");
}

TEST(Uses, where_defaults_were_filled_in_assignments_alone_are_judged) {
  Deck deck = Deck::from_text(text, "x.xml");
  EXPECT_EQ(mistakes(deck, true), "");
  deck.set("method/penalty=3");
  EXPECT_EQ(mistakes(deck, true),
            "--set method/penalty=3: method/penalty: this is used only with method/name = dg; leave it out, or write method/name = dg.");
}

TEST(Uses, a_deck_that_is_written_holds_what_takes_part_and_can_be_read) {
  for (const char* name : {"fem", "dg"}) {
    Whole params;
    params.method.name = name;
    const std::string written = to_xml(Whole::schema(), params, Whole::uses());
    EXPECT_EQ(mistakes(Deck::from_text(written, "deck.xml")), "") << written;
    EXPECT_EQ(contains(written, "restart"), params.method.name == "fem") << written;
    EXPECT_EQ(contains(written, "penalty"), params.method.name == "dg") << written;
  }
}

TEST(Uses, descriptions_tell_the_condition_and_skeletons_heed_it) {
  EXPECT_TRUE(contains(describe(Whole::schema(), "method", Format::text, Whole::uses()), "Of the jumps. Only with method/name = dg."));
  EXPECT_TRUE(contains(describe(Whole::schema(), "", Format::xml, Whole::uses()), "<!-- <Parameter name=\"penalty\""));
  Whole params;
  const std::string skeleton_of_fem = skeleton(Whole::schema(), params, Whole::uses());
  EXPECT_TRUE(contains(skeleton_of_fem, "restart") && !contains(skeleton_of_fem, "    <Parameter name=\"penalty\"")) << skeleton_of_fem;
  params.method.name = "dg";
  const std::string skeleton_of_dg = skeleton(Whole::schema(), params, Whole::uses());
  EXPECT_TRUE(!contains(skeleton_of_dg, "restart") && contains(skeleton_of_dg, "    <Parameter name=\"penalty\"")) << skeleton_of_dg;
  EXPECT_EQ(mistakes(Deck::from_text(skeleton_of_dg, "deck.xml")), "");
}

TEST(Differences, are_named_by_their_paths_and_say_both_values) {
  Whole a, b;
  b.method.penalty = 11;
  b.linear.parts["left"];
  EXPECT_TRUE(differences(Whole::schema(), a, a).empty());
  std::vector<std::string> paths;
  for (const auto& difference : differences(Whole::schema(), a, b)) paths.push_back(difference.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"method/penalty", "linear/parts/left/name", "linear/parts/left/penalty"}));
  EXPECT_EQ(differences(Whole::schema(), a, b)[0].sentence(), "method/penalty = 11 (was 10)");
  EXPECT_EQ(differences(Whole::schema(), b, a)[1].sentence().substr(0, 33), "linear/parts/left/name = not give");
}

}  // namespace thixis::core
