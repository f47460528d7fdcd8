/// What is written from a schema: the full deck, descriptions, skeletons.
#include <gtest/gtest.h>

#include "core/params.hpp"

namespace thixis::core::test {

namespace {
RunParams unusual() {
  RunParams p;
  p.scene.model = Model::obstacle;
  p.scene.constants = {{"R", 1.0 / 3}, {"k", 1e-8}};
  p.scene.boundary["left & \"right\""].value.text = "x < R ? 1 : 2";
  p.scene.boundary["top"].kind = "neumann";
  p.scene.interface = Formula{"x - R"};
  p.mesh.lower = {-0.1, 1e22};
  p.mesh.cells = {3, 4};
  p.mesh.tags = {"a", "b c"};
  p.newton.damping = 0.1 + 0.2;
  p.newton.nested = true;
  p.newton.c_function = CFunction::fischer_burmeister;
  p.newton.target = 1e-12;
  p.newton.initial.u1.text = "2";
  p.time = TimeParams{7};
  return p;
}
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
}  // namespace

TEST(DeckOutput, the_full_deck_reads_back_to_equal_parameters) {
  const RunParams p = unusual();
  const std::string text = to_xml(RunParams::schema(), p);
  const RunParams q = parse(text);
  EXPECT_EQ(q.scene.model, p.scene.model);
  EXPECT_EQ(q.scene.constants, p.scene.constants);
  EXPECT_EQ(q.scene.boundary, p.scene.boundary);
  EXPECT_EQ(q.scene.interface, p.scene.interface);
  EXPECT_EQ(q.mesh.lower, p.mesh.lower);
  EXPECT_EQ(q.mesh.cells, p.mesh.cells);
  EXPECT_EQ(q.mesh.tags, p.mesh.tags);
  EXPECT_EQ(q.newton.damping, p.newton.damping);
  EXPECT_EQ(q.newton.nested, p.newton.nested);
  EXPECT_EQ(q.newton.c_function, p.newton.c_function);
  EXPECT_EQ(q.newton.target, p.newton.target);
  EXPECT_EQ(q.newton.initial, p.newton.initial);
  EXPECT_EQ(q.linear.max_iterations, p.linear.max_iterations);
  ASSERT_TRUE(q.time);
  EXPECT_EQ(q.time->end, 7);
  EXPECT_EQ(to_xml(RunParams::schema(), q), text);
}

TEST(DeckOutput, the_full_deck_holds_the_defaults) {
  const std::string text = to_xml(RunParams::schema(), parse(deck_with("")));
  EXPECT_TRUE(contains(text, "    <Parameter name=\"max iterations\" type=\"int\" value=\"50\"/>\n")) << text;
  EXPECT_TRUE(contains(text, "<Parameter name=\"tolerance\" type=\"double\" value=\"1e-8\"/>")) << text;
  EXPECT_FALSE(contains(text, "\"target\"")) << "an absent optional parameter stays absent";
  EXPECT_FALSE(contains(text, "\"time\"")) << "an absent optional block stays absent";
}

TEST(DeckOutput, texts_describe_every_parameter_of_a_block) {
  EXPECT_EQ(describe(RunParams::schema(), "newton", Format::text),
            "newton: How the nonlinear system is solved.\n"
            "  max iterations  int     50     at least 0                Newton steps after which the run ends unconverged.\n"
            "  damping         double  1      above 0 and below 2       Factor of the step.\n"
            "  nested          bool    false                            Whether to start from the coarser mesh.\n"
            "  c-function      string  min    min | fischer-burmeister  Function of the contact conditions.\n"
            "  target          double  none   above 0                   Residual to reach.\n"
            "\n"
            "newton/initial: Where Newton starts.\n"
            "  u1  double or expression  none    Upper membrane.\n"
            "  u2  double or expression  0       Lower membrane.\n");
}

TEST(DeckOutput, tables_describe_lists_with_free_names) {
  const std::string text = describe(RunParams::schema(), "scene", Format::markdown);
  EXPECT_TRUE(contains(text, "## scene\n\nWhat is solved.\n\n| parameter | type | default | values | meaning |\n|---|---|---|---|---|\n"))
      << text;
  EXPECT_TRUE(contains(text, "| `model` | string | required | membranes \\| obstacle | The equations. |\n")) << text;
  EXPECT_TRUE(contains(text, "## scene/boundary/<name>\n\nOne list for each tag.\n")) << text;
  EXPECT_TRUE(contains(text, "| `<name>` | double | none |  | Any number of entries with free names. |\n")) << text;
  EXPECT_FALSE(contains(text, "newton"));
}

TEST(DeckOutput, a_skeleton_can_be_read) {
  for (const char* path : {"", "scene", "newton", "newton/initial", "time", "scene/boundary"}) {
    const std::string text = describe(RunParams::schema(), path, Format::xml);
    EXPECT_EQ(error_of(text), "") << path << "\n" << text;
  }
  const std::string text = describe(RunParams::schema(), "newton", Format::xml);
  EXPECT_TRUE(contains(text, "<Parameter name=\"max iterations\" type=\"int\" value=\"50\"/>  <!-- Newton steps after which")) << text;
  EXPECT_TRUE(contains(text, "<!-- <Parameter name=\"target\" type=\"double\" value=\"1\"/>  Residual to reach. Values: above 0. -->"))
      << text;
  EXPECT_TRUE(contains(text, "name=\"model\"")) << "required elsewhere";
  EXPECT_FALSE(contains(text, "restart")) << "not asked for";
}

TEST(DeckOutput, an_unknown_block_is_an_error) {
  EXPECT_EQ(input_error([] { describe(RunParams::schema(), "newtn", Format::text); }), "no block 'newtn'. Did you mean 'newton'?");
  EXPECT_EQ(input_error([] { describe(RunParams::schema(), "fields", Format::text); }),
            "no block 'fields'. Blocks are scene, mesh, newton, linear, time.");
  EXPECT_EQ(input_error([] { describe(RunParams::schema(), "linear/restart", Format::text); }),
            "'linear' has no blocks in it; describe 'linear' itself.");
}

TEST(DeckOutput, a_name_described_twice_is_an_internal_error) {
  const auto twice = [] { Schema<TimeParams>("time", "").parameter("end", &TimeParams::end, "").parameter("end", &TimeParams::end, ""); };
  EXPECT_THROW(twice(), Error);
}

TEST(DeckOutput, a_default_out_of_its_range_is_an_internal_error) {
  const auto wrong = [] { Schema<TimeParams>("time", "").parameter("end", &TimeParams::end, above(1), ""); };
  EXPECT_THROW(wrong(), Error);
}

TEST(DeckOutput, an_empty_array_that_must_not_be_empty_is_not_given) {
  struct Params {
    std::vector<double> centre;
  };
  const auto schema = Schema<Params>("thixis", "").parameter("centre", &Params::centre, entries(2), "Middle.");
  EXPECT_EQ(to_xml(schema, Params{}), "<ParameterList name=\"thixis\">\n</ParameterList>\n");
  EXPECT_EQ(to_xml(schema, Params{{1, 2}}),
            "<ParameterList name=\"thixis\">\n  <Parameter name=\"centre\" type=\"Array(double)\" value=\"{1, 2}\"/>\n</ParameterList>\n");
}

}  // namespace thixis::core::test
