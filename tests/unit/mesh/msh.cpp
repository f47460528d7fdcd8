#include <gtest/gtest.h>

#include <sstream>

#include "msh_files.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/check.hpp"
#include "thixis/mesh/mesh.hpp"
#include "triangulation.hpp"

namespace thixis::mesh {
namespace {

constexpr Numbers all_numbers[] = {Numbers::text, Numbers::little_endian, Numbers::big_endian};

Triangulation read(const std::string& bytes) { return gmsh_triangulation(bytes, "it"); }

/// All that is read, as text.
std::string content(const Triangulation& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const auto& [x, y] : mesh.points) text << "point " << x << ' ' << y << '\n';
  for (const auto& [a, b, c] : mesh.cells) text << "cell " << a << ' ' << b << ' ' << c << '\n';
  for (const auto& [first, second, tag] : mesh.boundary) text << "edge " << first << ' ' << second << ' ' << mesh.tags[tag] << '\n';
  return text.str();
}

/// The sentence with which the bytes are refused.
std::string refusal(const std::string& bytes) {
  try {
    make_mesh(read(bytes), core::Comm());
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const auto found = text.find(old);
  EXPECT_NE(found, std::string::npos) << old;
  return text.replace(found, old.size(), by);
}

const std::string instead = "; correct it, or save the mesh anew.";

/// Format 2.2 with the corners of the unit square and these lines of elements.
std::string square(const std::string& elements, const std::string& nodes = "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n") {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n" + elements + "$EndElements\n";
}
const std::string two_triangles = "2\n1 2 2 5 1 1 2 3\n2 2 2 5 1 1 3 4\n";

}  // namespace

TEST(msh, is_the_same_in_either_format_and_with_all_kinds_of_numbers) {
  const std::string expected = content(read(msh_22(TwoSquares(), Numbers::text)));
  EXPECT_EQ(read(msh_22(TwoSquares(), Numbers::text)).cells.size(), 8u);
  for (const Numbers numbers : all_numbers) {
    EXPECT_EQ(content(read(msh_22(TwoSquares(), numbers))), expected);
    EXPECT_EQ(content(read(msh_41(TwoSquares(), numbers))), expected);
  }
}

TEST(msh, of_a_partitioned_mesh_is_read_without_the_copies_of_cells) {
  TwoSquares parts;
  parts.partitioned = true;
  const std::string expected = content(read(msh_22(TwoSquares(), Numbers::text)));
  for (const Numbers numbers : all_numbers) {
    EXPECT_EQ(content(read(msh_22(parts, numbers))), expected);
    EXPECT_EQ(content(read(msh_41(parts, numbers))), expected);
  }
}

TEST(msh, with_one_part_of_a_partitioned_mesh_is_refused) {
  const std::string expected =
      "it holds 1 of the 2 parts of a partitioned mesh; give the whole mesh in one file (in Gmsh: Mesh.PartitionSplitMeshFiles = 0).";
  EXPECT_EQ(refusal(square("2\n1 2 5 5 1 2 1 -2 1 2 3\n2 2 5 5 1 2 1 -2 1 3 4\n")), expected);
  EXPECT_EQ(refusal(square("2\n1 2 4 5 1 1 2 1 2 3\n2 2 4 5 1 1 2 1 3 4\n")), expected);
  EXPECT_EQ(read(square("2\n1 2 4 5 1 1 1 1 2 3\n2 2 4 5 1 1 1 1 3 4\n")).cells.size(), 2u);
  TwoSquares parts;
  parts.partitioned = true;
  std::string file = replaced(msh_41(parts, Numbers::text), "11 19 1 15", "10 15 1 15");
  const auto second = file.find("2 2 2 4 \n"), ghosts = file.find("2 3 2 2 \n");
  ASSERT_LT(second, ghosts);
  EXPECT_EQ(refusal(file.erase(second, ghosts - second)), expected);
}

TEST(msh, with_parameters_of_nodes_is_read_without_them) {
  const std::string plain = content(read(square(two_triangles)));
  std::string nodes = "4\n1 0 0 0 0 1\n2 1 0 0 1 4 0.5\n3 1 1 0 2 1 0.5 0.25\n4 0 1 0 3 1\n";
  std::string old_format = replaced(square(two_triangles, nodes), "$Nodes", "$ParametricNodes");
  EXPECT_EQ(content(read(replaced(old_format, "$EndNodes", "$EndParametricNodes"))), plain);
  std::string new_format =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 4 1 4\n1 1 1 2\n1\n2\n0 0 0 0.5\n1 0 0 nan\n2 1 1 2\n3\n4\n1 1 0 0.5 7\n0 1 0 1 1\n"
      "$EndNodes\n$Elements\n1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 3 4\n$EndElements\n";
  EXPECT_EQ(content(read(new_format)), plain);
}

TEST(msh, may_hold_a_triangle_once_for_each_group_of_its_surface) {
  EXPECT_EQ(content(read(square("4\n1 2 2 5 1 1 2 3\n2 2 2 6 1 1 2 3\n3 2 2 5 1 1 3 4\n4 2 2 -6 1 4 3 1\n"))),
            content(read(square(two_triangles))));
  const std::string overlap =
      "it: triangles overlap at the edge from (0, 0) to (1, 0); give a plane mesh in which an edge has two triangles at most.";
  EXPECT_EQ(refusal(square("3\n1 2 2 5 1 1 2 3\n2 2 2 5 1 1 2 3\n3 2 2 6 1 1 3 4\n")), overlap);
  EXPECT_EQ(refusal(square("3\n1 2 2 5 1 1 2 3\n2 2 2 6 2 1 2 3\n3 2 2 6 1 1 3 4\n")), overlap);
}

TEST(msh, gives_its_coordinates_to_the_last_bit) {
  const std::vector<double> values = {0.1, 1 / 3.0, 4.9406564584124654e-324, 123456789.12345678, 1e100, 2.2250738585072011e-308};
  TwoSquares mesh;
  for (const double value : values)
    for (const double sign : {1.0, -1.0}) {
      mesh.points[0] = {sign * value, value};
      for (const Numbers numbers : all_numbers)
        for (const std::string& file : {msh_22(mesh, numbers), msh_41(mesh, numbers)}) EXPECT_EQ(read(file).points[0], mesh.points[0]);
    }
  EXPECT_EQ(read(square(two_triangles, "4\n1 +0.5 .25 -0e5\n2 1 0 0\n3 1 1 0\n4 0 1 0\n")).points[0], (std::array<double, 2>{0.5, 0.25}));
}

TEST(msh, may_have_comments_and_data_that_are_no_mesh) {
  const std::string whole = square(two_triangles), plain = content(read(whole));
  EXPECT_EQ(content(read("\n\n $Comments\n$MeshFormat\n1.0\n$EndMeshFormat here\n$EndComments\n" + whole)), plain);
  EXPECT_EQ(content(read(whole + "$NodeData\n1\n\"u\"\n$EndNodeDat\n  $EndNodeData\n$EndNodeData")), plain);
  EXPECT_EQ(content(read(replaced(whole, "$Nodes", "$Periodic\n1\n0 2 1\n1\n1 2\n$EndPeriodic\n$Nodes"))), plain);
  std::string dos;
  for (const char c : whole) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(content(read(dos)), plain);
  EXPECT_EQ(refusal(whole + "$NodeData\n1\n"), "it, line 16: the section '$NodeData' has no end" + instead);
}

TEST(msh, is_told_from_everything_else) {
  const std::string none = "it is not a Gmsh mesh; save it as Gmsh mesh in format 4.1 or 2.2 (gmsh -save -format msh41).";
  for (const std::string other : {"", " \n", "/*\n$MeshFormat\n2.2 0 8\n$EndMeshFormat\n*/\nPoint(1) = {0, 0, 0, 1};\n", "(0 \"fluent\")\n",
                                  "$Comments\n$MeshFormat\n$EndComments\n", "\x1f\x8b\x08"})
    EXPECT_EQ(refusal(other), none);
  EXPECT_EQ(refusal("$NOD\n1\n1 0 0 0\n$ENDNOD\n"), replaced(none, "is not a Gmsh mesh", "has format 1"));
  EXPECT_EQ(refusal("$MeshFormat\n4 0 8\n$EndMeshFormat\n"), replaced(none, "is not a Gmsh mesh", "has format 4"));
  EXPECT_EQ(refusal("$Nodes\n0\n$EndNodes\n"), "it, line 1: the section $MeshFormat must come before $Nodes" + instead);
  EXPECT_EQ(refusal("$MeshFormat\n2.2 2 8\n$EndMeshFormat\n"), "it, line 2: the file is text (0) or binary (1), not 2" + instead);
  EXPECT_EQ(refusal("$MeshFormat\n4.1 1 4\n\1\0\0\0\n$EndMeshFormat\n"),
            "it, line 2: numbers of 4 bytes can not be read, only those of 8" + instead);
  EXPECT_EQ(refusal("$MeshFormat\n4.1 1 8\n\1\1\1\1\n$EndMeshFormat\n"),
            "it, byte 24: the first number of a binary file is 1, but this one is not" + instead);
  EXPECT_EQ(refusal(square(two_triangles) + "SystemCall \"true\";\n"),
            "it, line 16: 'SystemCall' stands outside of all sections" + instead);
}

TEST(msh, that_is_damaged_is_refused_with_the_place) {
  const std::string whole = square(two_triangles);
  const auto damaged = [&](const std::string& old, const std::string& by) { return refusal(replaced(whole, old, by)); };
  EXPECT_EQ(damaged("$Nodes\n4", "$Nodes\n3"), "it, line 9: the section $Nodes holds more than its counts say" + instead);
  EXPECT_EQ(damaged("$Nodes\n4", "$Nodes\n5"), "it, line 10: '$EndNodes' comes before all that the counts of $Nodes promise" + instead);
  EXPECT_EQ(damaged("$Nodes\n4", "$Nodes\n-1"), "it, line 5: the count -1 is more than the file holds" + instead);
  EXPECT_EQ(damaged("$Nodes\n4", "$Nodes\n2000000000"), "it, line 5: the count 2000000000 is more than the file holds" + instead);
  EXPECT_EQ(damaged("$Nodes\n4", "$Nodes\n99999999999"), "it, line 5: '99999999999' is no whole number of 32 bits" + instead);
  EXPECT_EQ(damaged("$Elements\n2", "$Elements\n1"), "it, line 14: the section $Elements holds more than its counts say" + instead);
  EXPECT_EQ(damaged("$Elements\n2", "$Elements\n3"),
            "it, line 15: '$EndElements' comes before all that the counts of $Elements promise" + instead);
  EXPECT_EQ(damaged("3 1 1 0", "3 1 1 0 0"), "it, line 8: the line goes on where it should end" + instead);
  EXPECT_EQ(damaged("3 1 1 0", "3 1 1"), "it, line 8: the line ends too early" + instead);
  EXPECT_EQ(damaged("3 1 1 0", "3 1 1.O 0"), "it, line 8: '1.O' is no number" + instead);
  for (const char* wrong : {"nan", "-inf", "1e101"})
    EXPECT_EQ(damaged("3 1 1 0", std::string("3 ") + wrong + " 1 0"),
              "it, line 8: a coordinate is not finite, or too large to compute with" + instead);
  EXPECT_EQ(damaged("3 1 1 0", "3 1e999 1 0"), "it, line 8: '1e999' is no number" + instead);
  EXPECT_EQ(damaged("3 1 1 0", "-3 1 1 0"), "it, line 8: -3 is no number of a node" + instead);
  EXPECT_EQ(damaged("3 1 1 0", "2 1 1 0"), "it has two nodes with the number 2; number them differently, or save it anew.");
  EXPECT_EQ(damaged("4 0 1 0", "5 0 1 0"), "it: the triangle 2 has the node 4, which is not in the file" + instead);
  EXPECT_EQ(damaged("\n2 2 2 5", "\n1 2 2 5"), "it has two elements with the number 1; number them differently, or save it anew.");
  EXPECT_EQ(damaged("\n2 2 2 5", "\n-2 2 2 5"), "it, line 14: -2 is no number of an element" + instead);
  EXPECT_EQ(damaged("\n2 2 2 5", "\n2 2 -2 5"), "it, line 14: the count -2 is more than the file holds" + instead);
  EXPECT_EQ(damaged("$EndElements\n", ""), "it, line 14: the file ends before $EndElements" + instead);
  EXPECT_EQ(damaged("$EndNodes\n", "$EndNodes\n$Nodes\n0\n$EndNodes\n"), "it, line 11: the section $Nodes is there twice" + instead);
  EXPECT_EQ(damaged("2 2 2 5 1 1 3 4", "2 8 2 5 1 1 3 4"),
            "it has elements of the kind 'Line 3'; give a plane mesh of straight triangles (in Gmsh: element order 1, no recombination).");
  EXPECT_EQ(damaged("2 2 2 5 1 1 3 4", "2 93 2 5 1 1 3 4"),
            "it has elements of the kind 'type 93'; give a plane mesh of straight triangles (in Gmsh: element order 1, no recombination).");
  const std::string names = "$PhysicalNames\n1\n1 5 \"\x1b[2J\"\n$EndPhysicalNames\n$Nodes";
  EXPECT_EQ(damaged("$Nodes", names),
            "it, line 6: the name of a physical group stands in quotes, without control characters and without ' ∩ '" + instead);
  for (std::size_t length = whole.find("$EndMeshFormat"); length + 1 < whole.size(); ++length)
    EXPECT_NE(refusal(whole.substr(0, length)), "accepted");
}

TEST(msh, of_format_41_that_is_damaged_is_refused_with_the_place) {
  const std::string whole = msh_41(TwoSquares(), Numbers::text);
  const auto damaged = [&](const std::string& old, const std::string& by) { return refusal(replaced(whole, old, by)); };
  EXPECT_EQ(damaged("\n1 8 1 8 \n", "\n1 9 1 8 \n"), "it, line 40: the blocks hold 8 nodes, not the 9 that the section promises" + instead);
  EXPECT_EQ(damaged("\n1 8 1 8 \n", "\n2 8 1 8 \n"),
            "it, line 41: '$EndNodes' comes before all that the counts of $Nodes promise" + instead);
  EXPECT_EQ(damaged("\n2 1 0 8 \n", "\n2 1 0 -8 \n"), "it, line 24: -8 is no number of a node or element, and no count" + instead);
  EXPECT_EQ(damaged("\n2 1 0 8 \n", "\n2 1 0 9223372036854775807 \n"),
            "it, line 24: the count 9223372036854775807 is more than the file holds" + instead);
  EXPECT_EQ(damaged("\n2 1 2 4 \n", "\n1 1 2 4 \n"),
            "it, line 58: the kind 'Triangle 3' does not belong to an entity of this dimension" + instead);
  const std::string entities = whole.substr(whole.find("$Entities"), whole.find("$Nodes") - whole.find("$Entities"));
  EXPECT_EQ(refusal(replaced(whole, entities, "") + entities), "it, line 59: entities must come before nodes and elements" + instead);
  for (const Numbers numbers : {Numbers::little_endian, Numbers::big_endian})
    for (const std::string& file : {msh_22(TwoSquares(), numbers), msh_41(TwoSquares(), numbers)})
      for (std::size_t length = 0; length + 1 < file.size(); ++length) EXPECT_NE(refusal(file.substr(0, length)), "accepted");
}

TEST(msh, puts_an_edge_into_all_groups_of_its_curve) {
  const Mesh mesh = make_mesh(read(msh_41(TwoSquares(), Numbers::text)), core::Comm());
  EXPECT_EQ(mesh.tags, (std::vector<std::string>{"bottom side", "right ∩ rim", "left ∩ rim", "rim"}));
  EXPECT_EQ(check(mesh), std::vector<std::string>());
}

}  // namespace thixis::mesh
