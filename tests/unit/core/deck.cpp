#include "thixis/core/deck.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/params.hpp"

namespace thixis::core::test {

TEST(Deck, an_empty_block_leaves_all_defaults) {
  const RunParams p = parse(deck_with("<ParameterList name=\"newton\"/>\n"));
  EXPECT_EQ(p.newton.max_iterations, 50);
  EXPECT_EQ(p.linear.preconditioner, "ilu");
  EXPECT_EQ(p.mesh.lower, (std::vector<double>{0, 0}));
  EXPECT_FALSE(p.newton.target);
  EXPECT_FALSE(p.time);
  EXPECT_EQ(p.scene.model, Model::obstacle);
}

TEST(Deck, reads_every_type) {
  const RunParams p = parse(deck_with(R"xml(
    <ParameterList name="newton">
      <Parameter name="max iterations" type="int" value="7"/>
      <Parameter name="damping" type="double" value="5e-1"/>
      <Parameter name="nested" type="bool" value="true"/>
      <Parameter name="c-function" type="string" value="fischer-burmeister"/>
      <Parameter name="target" type="int" value="+2"/>
      <ParameterList name="initial"><Parameter name="u1" type="string" value="x &lt; 1 &amp;&amp; y > 0 ? 1 : 0"/></ParameterList>
    </ParameterList>
    <ParameterList name="mesh">
      <Parameter name="lower" type="Array(double)" value="{-1, 2.5e-1}"/>
      <Parameter name="cells" type="Array(int)" value="{ 3,5 }"/>
      <Parameter name="tags" type="Array(string)" value="{left, right side}"/>
    </ParameterList>
    <ParameterList name="linear"><Parameter name="max iterations" type="long long" value="5000000000"/></ParameterList>
    <ParameterList name="time"><Parameter name="end" type="double" value="3"/></ParameterList>
)xml"));
  EXPECT_EQ(p.newton.max_iterations, 7);
  EXPECT_EQ(p.newton.damping, 0.5);
  EXPECT_TRUE(p.newton.nested);
  EXPECT_EQ(p.newton.c_function, CFunction::fischer_burmeister);
  EXPECT_EQ(p.newton.target, 2.0);
  EXPECT_EQ(p.newton.initial.u1.text, "x < 1 && y > 0 ? 1 : 0");
  EXPECT_EQ(p.mesh.lower, (std::vector<double>{-1, 0.25}));
  EXPECT_EQ(p.mesh.cells, (std::vector<int>{3, 5}));
  EXPECT_EQ(p.mesh.tags, (std::vector<std::string>{"left", "right side"}));
  EXPECT_EQ(p.linear.max_iterations, 5000000000LL);
  ASSERT_TRUE(p.time);
  EXPECT_EQ(p.time->end, 3.0);
}

TEST(Deck, reads_lists_and_parameters_with_free_names) {
  const auto scene = parse(R"xml(<ParameterList name="thixis"><ParameterList name="scene">
  <Parameter name="model" type="string" value="membranes"/>
  <ParameterList name="constants"><Parameter name="R" type="double" value="0.25"/></ParameterList>
  <ParameterList name="boundary">
    <ParameterList name="left"><Parameter name="value" type="string" value="R*x"/></ParameterList>
    <ParameterList name="top side"><Parameter name="kind" type="string" value="neumann"/><Parameter name="value" type="double" value="3"/></ParameterList>
  </ParameterList></ParameterList></ParameterList>)xml")
                         .scene;
  EXPECT_EQ(scene.constants.at("R"), 0.25);
  EXPECT_EQ(scene.boundary.at("left").value.text, "R*x");
  EXPECT_EQ(scene.boundary.at("left").kind, "dirichlet");
  EXPECT_EQ(scene.boundary.at("top side").value.text, "3");
  EXPECT_EQ(scene.boundary.at("top side").kind, "neumann");
}

TEST(Deck, accepts_what_teuchos_writes_beside_the_values) {
  const RunParams p = parse(deck_with(R"xml(<ParameterList id="1" name="newton">
    <Parameter docString="steps" id="0" isDefault="false" isUsed="true" name="max iterations" type="int" value="3"/></ParameterList>)xml"));
  EXPECT_EQ(p.newton.max_iterations, 3);
}

TEST(Deck, an_assignment_overrides_the_deck_and_creates_blocks) {
  Deck deck = Deck::from_text(
      deck_with("<ParameterList name=\"newton\"><Parameter name=\"max iterations\" type=\"int\" value=\"3\"/></ParameterList>\n"), "x.xml");
  for (const char* assignment : {"newton/max iterations=4", "mesh/lower={-1,0.5}", "newton/initial/u1=x == y ? 1 : 0", "time/end=2",
                                 "newton/nested=true", "newton/c-function=fischer-burmeister", "scene/boundary/left/kind=neumann",
                                 "scene/constants/R=2", "newton/damping=0.5", "newton/damping=1.5"})
    deck.set(assignment);
  const RunParams p = deck.parse(RunParams::schema());
  EXPECT_EQ(p.newton.max_iterations, 4);
  EXPECT_EQ(p.mesh.lower, (std::vector<double>{-1, 0.5}));
  EXPECT_EQ(p.newton.initial.u1.text, "x == y ? 1 : 0");
  EXPECT_EQ(p.time->end, 2.0);
  EXPECT_TRUE(p.newton.nested);
  EXPECT_EQ(p.newton.c_function, CFunction::fischer_burmeister);
  EXPECT_EQ(p.scene.boundary.at("left").kind, "neumann");
  EXPECT_EQ(p.scene.constants.at("R"), 2.0);
  EXPECT_EQ(p.newton.damping, 1.5) << "the last assignment wins";
}

TEST(Deck, an_assignment_mends_a_wrong_value_of_the_deck) {
  Deck deck = Deck::from_text(
      deck_with("<ParameterList name=\"newton\"><Parameter name=\"max iterations\" type=\"int\" value=\"many\"/></ParameterList>\n"),
      "x.xml");
  deck.set("newton/max iterations=4");
  EXPECT_EQ(deck.parse(RunParams::schema()).newton.max_iterations, 4);
}

TEST(Deck, knows_where_an_entry_stands) {
  Deck deck = Deck::from_text(
      deck_with("<ParameterList name=\"newton\">\n<Parameter name=\"damping\" type=\"int\" value=\"1\"/></ParameterList>\n"),
      "inputs/x.xml");
  deck.set("linear/restart=5");
  EXPECT_STREQ(deck.error("newton/damping", "does not fit the mesh.").what(), "inputs/x.xml:4: newton/damping: does not fit the mesh.");
  EXPECT_STREQ(deck.error("newton/initial/u1", "is wrong.").what(), "inputs/x.xml:3: newton/initial/u1: is wrong.");
  EXPECT_STREQ(deck.error("linear/restart", "is wrong.").what(), "--set linear/restart=5: linear/restart: is wrong.");
  EXPECT_TRUE(deck.given("newton/damping"));
  EXPECT_FALSE(deck.given("newton/nested"));
  EXPECT_EQ(deck.folder(), "inputs");
  EXPECT_EQ(deck.stem(), "x");
  EXPECT_EQ(Deck::from_text(deck_with(""), "y.xml").folder(), ".");
  EXPECT_EQ(Deck::from_text(deck_with(""), "y.xml", "/meshes").folder(), "/meshes");
}

TEST(Deck, is_read_from_a_file_the_same_on_all_ranks) {
  const Comm comm;
  const std::string path = ::testing::TempDir() + "thixis_deck_" + std::to_string(comm.size()) + ".xml";
  comm.on_root([&] { std::ofstream(path) << deck_with(""); });
  EXPECT_EQ(Deck::read(path).parse(RunParams::schema()).scene.model, Model::obstacle);
  comm.barrier();
  comm.on_root([&] { std::remove(path.c_str()); });
  try {
    Deck::read("no/such/deck.xml");
    FAIL() << "nothing was thrown";
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(), "no/such/deck.xml: there is no such file; give the path of a deck.");
  }
  EXPECT_THROW(Deck::read("/tmp"), FileError);
}

TEST(Deck, numbers_do_not_depend_on_the_locale) {
  const WithDecimalComma german;
  const auto newton =
      parse(deck_with("<ParameterList name=\"newton\"><Parameter name=\"damping\" type=\"double\" value=\"1.5\"/></ParameterList>")).newton;
  EXPECT_EQ(newton.damping, 1.5);
  RunParams p;
  p.newton = newton;
  p.newton.max_iterations = 12345;
  const std::string text = to_xml(RunParams::schema(), p);
  EXPECT_NE(text.find("value=\"1.5\""), std::string::npos);
  EXPECT_NE(text.find("value=\"12345\""), std::string::npos);
}

}  // namespace thixis::core::test
