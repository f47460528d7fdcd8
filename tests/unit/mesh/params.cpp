#include <gtest/gtest.h>

#include "lengths.hpp"
#include "meshes.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/statistics.hpp"

namespace thixis::mesh {
namespace {

/// The sentence with which build refuses the parameters.
std::string refusal(const MeshParams& params) {
  try {
    build(params, core::Comm(), ".");
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

/// What the deck with these parameters in the block is refused with, file and line left out; empty if it is accepted.
std::string deck_refusal(const std::string& parameters) {
  try {
    core::Deck::from_text("<ParameterList name=\"mesh\">\n" + parameters + "</ParameterList>\n", "deck.xml").parse(MeshParams::schema());
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(rectangle, takes_whole_multiples_only_and_says_what_to_write) {
  MeshParams params;
  params.cells_per_side = 2;
  params.upper = {1, 1.7};
  EXPECT_EQ(
      refusal(params),
      "mesh/cells per side: 2 squares along the shorter side are 3.4 along the longer one; write another number, or corners such that "
      "the longer side is a whole multiple of 0.5.");
  params.cells_per_side = 10;
  const Hierarchy hierarchy = build(params, core::Comm(), ".");
  EXPECT_EQ(hierarchy.finest().global_cells, 4 * 10 * 17);
  EXPECT_NEAR(statistics(hierarchy.finest()).h_max, 0.1, 1e-14);
}

TEST(rectangle, may_lie_either_way) {
  MeshParams params;
  params.generator = Generator::rectangle;
  params.cells_per_side = 2;
  params.lower = {-3, 1};
  params.upper = {3, 3};
  EXPECT_EQ(build(params, core::Comm(), ".").finest().global_cells, 2 * 2 * 6);
  params.lower = {1, -3};
  params.upper = {3, 3};
  const Mesh mesh = build(params, core::Comm(), ".").finest();
  EXPECT_EQ(mesh.global_cells, 2 * 2 * 6);
  EXPECT_NEAR(statistics(mesh).area, 12, 1e-13);
}

TEST(rectangle, needs_its_upper_corner_above_the_lower_one) {
  MeshParams params;
  for (const auto& upper : {std::vector<double>{1, 0}, {-1, 1}, {1, NAN}, {INFINITY, 1}}) {
    params.upper = upper;
    EXPECT_EQ(refusal(params), "mesh/upper: write finite coordinates, each larger than that of 'lower'.");
  }
  params.upper = {1, 1, 1};
  EXPECT_EQ(refusal(params), "mesh/upper: write two coordinates, such as {1, 1}.");
}

TEST(parameters, of_meshes_too_large_to_hold_are_refused) {
  MeshParams params;
  params.cells_per_side = 100000;
  EXPECT_EQ(refusal(params), "mesh/cells per side: every rank holds the coarsest mesh; write fewer cells per side and more refinements.");
  params.generator = Generator::disk;
  params.rings = 100000;
  EXPECT_EQ(refusal(params), "mesh/rings: every rank holds the coarsest mesh; write fewer rings and more refinements.");
  params.rings = 1;
  params.refinements = 20;
  EXPECT_EQ(refusal(params), "mesh/refinements: a rank would hold more than 500 million cells; write fewer refinements or use more ranks.");
}

TEST(parameters, out_of_range_are_refused) {
  MeshParams params;
  params.cells_per_side = 0;
  EXPECT_EQ(refusal(params), "mesh/cells per side: write a number from 1.");
  params.cells_per_side = 1;
  params.refinements = -1;
  EXPECT_EQ(refusal(params), "mesh/refinements: write a number from 0.");
}

TEST(parameters, with_a_file_need_the_generator_file_and_the_other_way_round) {
  MeshParams params;
  params.file = "plate.msh";
  EXPECT_EQ(refusal(params), "mesh/file: only the generator 'file' reads a mesh; write that, or leave out the file.");
  params.file = "";
  params.generator = Generator::file;
  EXPECT_EQ(refusal(params), "mesh/file: write the name of a Gmsh mesh, or choose another generator.");
}

TEST(parameters, of_intervals_and_rectangles_describe_no_triangles) {
  MeshParams params;
  params.generator = Generator::interval;
  params.cells = {10};
  EXPECT_FALSE(mistake(params));
  EXPECT_EQ(refusal(params),
            "mesh/generator: an interval has no triangles, and only the method fv can do without; write method/name = fv, or one of the "
            "generators criss-cross, rectangle, disk, file.");
  params.generator = Generator::tensor;
  params.cells = {10, 20};
  EXPECT_FALSE(mistake(params));
  EXPECT_EQ(refusal(params).substr(0, 46), "mesh/generator: a tensor grid has no triangles");
  params.generator = Generator::rectangle;
  EXPECT_EQ(refusal(params),
            "mesh/cells: only the generators 'interval' and 'tensor' are counted in cells; write one of them, or leave out the cells.");
}

TEST(deck, that_describes_a_mesh_is_read) {
  const auto deck = core::Deck::from_text(
      "<ParameterList name=\"mesh\">\n"
      "<Parameter name=\"generator\" type=\"string\" value=\"rectangle\"/>\n"
      "<Parameter name=\"cells per side\" type=\"int\" value=\"3\"/>\n"
      "<Parameter name=\"upper\" type=\"Array(double)\" value=\"{2, 1}\"/>\n"
      "<Parameter name=\"refinements\" type=\"int\" value=\"1\"/>\n"
      "</ParameterList>\n",
      "deck.xml");
  const Hierarchy hierarchy = build(deck.parse(MeshParams::schema()), core::Comm(), deck.folder());
  EXPECT_EQ(hierarchy.levels[0].global_cells, 2 * 3 * 6);
  EXPECT_EQ(hierarchy.finest().global_cells, 2 * 6 * 12);
}

TEST(deck, with_mistakes_is_refused_before_any_mesh_is_built) {
  EXPECT_EQ(
      deck_refusal("<Parameter name=\"cells per side\" type=\"int\" value=\"2\"/>\n"
                   "<Parameter name=\"upper\" type=\"Array(double)\" value=\"{1, 1.7}\"/>\n"),
      "deck.xml:2: cells per side: 2 squares along the shorter side are 3.4 along the longer one; write another number, or corners such "
      "that the longer side is a whole multiple of 0.5.");
  EXPECT_EQ(deck_refusal("<Parameter name=\"generator\" type=\"string\" value=\"file\"/>\n"),
            "deck.xml:1: file: write the name of a Gmsh mesh, or choose another generator.");
  EXPECT_EQ(deck_refusal("<Parameter name=\"lower\" type=\"Array(double)\" value=\"{0}\"/>\n"),
            "deck.xml:2: lower: write two coordinates, such as {0, 0}.");
  EXPECT_EQ(deck_refusal("<Parameter name=\"generator\" type=\"string\" value=\"interval\"/>\n"),
            "deck.xml:1: cells: write the number of intervals, such as {100}.");
  EXPECT_NE(deck_refusal("<Parameter name=\"generator\" type=\"string\" value=\"triangle\"/>\n"), "");
}

TEST(lengths, that_arithmetic_can_not_follow_are_refused) {
  EXPECT_EQ(lengths_mistake(1, 0.1), "");
  EXPECT_EQ(lengths_mistake(1e14, 0.125), "");
  EXPECT_EQ(lengths_mistake(1e60, 1e59), "");
  EXPECT_EQ(lengths_mistake(1e-59, 1e-60), "");
  EXPECT_NE(lengths_mistake(1e15, 0.125).find("no digits"), std::string::npos);
  EXPECT_NE(lengths_mistake(1e61, 1e60).find("units"), std::string::npos);
  EXPECT_NE(lengths_mistake(1e-59, 1e-61).find("units"), std::string::npos);
}

TEST(lengths, are_those_of_the_cells_of_each_generator) {
  MeshParams params;
  params.lower = {1e10, 1e10};
  params.upper = {1e10 + 1, 1e10 + 1};
  params.cells_per_side = 1000;
  EXPECT_FALSE(mistake(params));
  params.refinements = 12;
  EXPECT_TRUE(mistake(params));
  params.refinements = 0;
  params.cells = {1000000, 1};
  params.generator = Generator::tensor;
  EXPECT_TRUE(mistake(params));
  params.cells = {1000, 1};
  EXPECT_FALSE(mistake(params));
}

}  // namespace thixis::mesh
