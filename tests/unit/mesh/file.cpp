#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "meshes.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/check.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/statistics.hpp"

namespace thixis::mesh {
namespace {

Hierarchy import(const std::string& file, int refinements = 0, const std::string& folder = MESH_FILES) {
  MeshParams params;
  params.generator = Generator::file;
  params.file = file;
  params.refinements = refinements;
  params.cells_per_rank = 10;
  return build(params, core::Comm(), folder);
}

/// Total length of the faces of the boundary by tag, in twentieths.
std::map<std::string, long> lengths(const Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  std::vector<double> length(mesh.tags.size(), 0);
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    if (host.face_tag(F) >= 0 && mesh.face_owner[F] == mesh.comm.rank())
      length[host.face_tag(F)] += face_geometry(host.coordinates, host.face_vertices, F).length;
  mesh.comm.sum(length);
  std::map<std::string, long> by_tag;
  for (std::size_t tag = 0; tag < length.size(); ++tag) by_tag[mesh.tags[tag]] = std::lround(20 * length[tag]);
  return by_tag;
}

/// A file with this content, written by the root, removed at the end.
class Scratch {
 public:
  explicit Scratch(const std::string& content, const std::string& ending = ".msh") {
    long long process = getpid();
    comm_.broadcast(process);
    path_ = std::filesystem::temp_directory_path() / ("thixis-mesh-" + std::to_string(process) + ending);
    if (comm_.root()) std::ofstream(path_, std::ios::binary) << content;
    comm_.barrier();
  }
  ~Scratch() {
    comm_.barrier();
    if (comm_.root()) std::filesystem::remove(path_);
  }
  std::string path() const { return path_.string(); }

 private:
  core::Comm comm_;
  std::filesystem::path path_;
};

/// Format 2.2 with the nodes (0,0), (1,0), (0,1), (1,1), (0.5,0.5), (2,0), (1,0) again, (2,1) numbered from 1, and these elements.
std::string with_elements(const std::vector<std::string>& elements, const std::string& version = "2.2", const std::string& z = "0") {
  std::ostringstream text;
  text << "$MeshFormat\n" << version << " 0 8\n$EndMeshFormat\n$Nodes\n8\n";
  text << "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 " << z << "\n5 0.5 0.5 0\n6 2 0 0\n7 1 0 0\n8 2 1 0\n$EndNodes\n$Elements\n"
       << elements.size() << '\n';
  for (std::size_t k = 0; k < elements.size(); ++k) text << k + 1 << ' ' << elements[k] << '\n';
  text << "$EndElements\n";
  return text.str();
}

/// The sentence with which the file is refused, without its name.
std::string refusal(const std::string& content) {
  const Scratch file(content);
  try {
    import(file.path());
  } catch (const core::InputError& error) {
    const std::string sentence = error.what(), name = "mesh/file: '" + file.path() + "'";
    EXPECT_EQ(sentence.substr(0, name.size()), name);
    return sentence.substr(name.size());
  }
  return "accepted";
}

}  // namespace

TEST(gmsh_file, of_either_format_gives_the_same_mesh) {
  const Mesh old_format = import("l_shape_22.msh").finest(), new_format = import("l_shape_41.msh").finest();
  EXPECT_EQ(old_format.global_cells, 12);
  EXPECT_EQ(old_format.global_vertices, 11);  // not the one without triangles
  EXPECT_EQ(old_format.tags, new_format.tags);
  EXPECT_EQ(PlainMesh(old_format).triangles, PlainMesh(new_format).triangles);
  EXPECT_EQ(lengths(old_format), lengths(new_format));
}

TEST(gmsh_file, names_the_parts_of_the_boundary_by_its_physical_curves) {
  for (const Mesh& mesh : import("l_shape_41.msh", 3).levels) {
    const std::map<std::string, long> by_tag = lengths(mesh);
    const std::map<std::string, long> expected = {{"clamped side", 80}, {"physical 7", 20}, {"boundary", 60}};
    EXPECT_EQ(by_tag, expected);
  }
}

TEST(gmsh_file, is_refined_consistently) {
  const Hierarchy hierarchy = import("l_shape_22.msh", 3);
  EXPECT_EQ(check(hierarchy), std::vector<std::string>());
  for (const Mesh& mesh : hierarchy.levels) EXPECT_NEAR(statistics(mesh).area, 3, 1e-14);
}

TEST(gmsh_file, may_have_clockwise_triangles) {
  const Scratch file(with_elements({"2 2 0 1 1 3 2", "2 2 0 1 2 3 4"}));
  EXPECT_EQ(check(import(file.path(), 2)), std::vector<std::string>());
}

TEST(gmsh_file, that_is_missing_is_a_file_error) {
  EXPECT_THROW(import("no_such.msh"), core::FileError);
  EXPECT_THROW(import("."), core::FileError);
}

TEST(gmsh_file, of_another_format_is_refused) {
  const std::string how = "; save it as Gmsh mesh in format 4.1 or 2.2 (gmsh -save -format msh41).";
  EXPECT_EQ(refusal("SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1, 0};\n"), " is not a Gmsh mesh" + how);
  EXPECT_EQ(refusal(""), " is not a Gmsh mesh" + how);
  EXPECT_EQ(refusal(with_elements({"2 2 0 1 1 2 3"}, "3.0")), " has format 3.0" + how);
}

TEST(gmsh_file, that_is_damaged_is_refused) {
  const std::string whole = with_elements({"2 2 0 1 1 2 3", "2 2 0 1 2 4 3"});
  for (const std::size_t length : {whole.find("$Nodes") + 9, whole.find("$Elements") + 15})
    EXPECT_NE(refusal(whole.substr(0, length)), "accepted");
  EXPECT_NE(refusal(with_elements({"2 2 0 1 1 2 77"})), "accepted");
}

TEST(gmsh_file, without_triangles_is_refused) {
  EXPECT_EQ(refusal(with_elements({"1 2 0 1 1 2"})),
            " has no triangles; give a mesh of a plane domain (gmsh -2, with its surfaces in a physical group or none).");
}

TEST(gmsh_file, with_other_elements_than_straight_triangles_is_refused) {
  const std::string instead = "'; give a plane mesh of straight triangles (in Gmsh: element order 1, no recombination).";
  EXPECT_EQ(refusal(with_elements({"3 2 0 1 1 2 4 3"})), " has elements of the kind 'Quadrilateral 4" + instead);
  EXPECT_EQ(refusal(with_elements({"9 2 0 1 1 6 3 2 5 4"})), " has elements of the kind 'Triangle 6" + instead);
  EXPECT_EQ(refusal(with_elements({"4 2 0 1 1 2 3 5"})), " has elements of the kind 'Tetrahedron 4" + instead);
}

TEST(gmsh_file, that_is_not_plane_is_refused) {
  EXPECT_EQ(refusal(with_elements({"2 2 0 1 1 2 3", "2 2 0 1 2 4 3"}, "2.2", "0.1")),
            " is not plane; give a mesh of which all nodes have the same z.");
}

TEST(gmsh_file, with_a_flat_triangle_is_refused) {
  EXPECT_EQ(refusal(with_elements({"2 2 0 1 1 2 6"})), ": the triangle at (0, 0) has no area; give a mesh without degenerate triangles.");
}

TEST(gmsh_file, with_overlapping_triangles_is_refused) {
  EXPECT_EQ(refusal(with_elements({"2 2 0 1 1 2 3", "2 2 0 1 1 2 5"})),
            ": triangles overlap at the edge from (0, 0) to (1, 0); give a plane mesh in which an edge has two triangles at most.");
}

TEST(gmsh_file, with_a_hanging_node_is_refused) {
  EXPECT_EQ(
      refusal(with_elements({"2 2 0 1 1 2 3", "2 2 0 1 2 4 5", "2 2 0 1 5 4 3"})),
      ": a node of the boundary lies inside an edge at (0.5, 0.5); give a conforming mesh (in Gmsh: merge duplicate nodes or entities "
      "with Coherence).");
}

TEST(gmsh_file, with_two_nodes_at_one_place_is_refused) {
  EXPECT_EQ(
      refusal(with_elements({"2 2 0 1 1 2 3", "2 2 0 1 7 6 8"})),
      ": two nodes of the boundary lie at (1, 0); give a conforming mesh (in Gmsh: merge duplicate nodes or entities with Coherence).");
}

/// 1e-5 wide and 1e5 high: what is near beside a face of 3e4 is far beside one of 3e-6.
TEST(gmsh_file, of_a_thin_domain_is_read) {
  constexpr int n = 3;
  std::ostringstream file;
  file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << (n + 1) * (n + 1) << '\n' << std::setprecision(17);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) file << 1 + i + (n + 1) * j << ' ' << 1e-5 * i / n << ' ' << 1e5 * j / n << " 0\n";
  file << "$EndNodes\n$Elements\n" << 2 * n * n << '\n';
  int number = 0;
  const auto triangle = [&](int a, int b, int c) { file << ++number << " 2 2 0 1 " << a << ' ' << b << ' ' << c << '\n'; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = 1 + i + (n + 1) * j, c = a + n + 1;
      triangle(a, a + 1, c + 1);
      triangle(a, c + 1, c);
    }
  file << "$EndElements\n";
  EXPECT_EQ(import(Scratch(file.str()).path()).finest().global_cells, 2 * n * n);
}

TEST(gmsh_file, whose_domain_touches_itself_is_refused) {
  EXPECT_EQ(refusal(with_elements({"2 2 0 1 1 2 3", "2 2 0 1 2 6 8"})),
            ": the domain touches itself in the vertex (1, 0); give a mesh whose boundary is made of simple closed curves.");
}

TEST(gmsh_file, with_loose_edges_in_a_group_is_refused) {
  EXPECT_EQ(
      refusal(with_elements({"2 2 0 1 1 2 3", "2 2 0 1 2 4 3", "1 2 5 9 1 4"})),
      ": the edge from (0, 0) to (1, 1) of the group 'physical 5' is no side of a triangle; give a mesh of the plane part only, without "
      "loose edges.");
  EXPECT_EQ(refusal(with_elements({"2 2 0 1 1 2 3", "2 2 0 1 2 4 3", "1 2 5 9 4 8"})),
            " has edges in physical groups that are no side of a triangle; remove them.");
}

TEST(gmsh_file, may_have_an_edge_in_two_groups) {
  const Scratch file(with_elements({"2 2 0 1 1 2 3", "1 2 5 8 1 2", "1 2 6 9 2 1", "1 2 6 9 1 3"}));
  const Mesh mesh = import(file.path(), 1).finest();
  const std::map<std::string, long> expected = {{"physical 5 ∩ physical 6", 20}, {"physical 6", 20}, {"boundary", 28}};
  EXPECT_EQ(lengths(mesh), expected);
}

TEST(gmsh_file, is_never_executed) {
  const Scratch witness("", "witness");
  std::filesystem::remove(witness.path());
  const std::string command = "SystemCall \"touch " + witness.path() + "\";\n", mesh = with_elements({"2 2 0 1 1 2 3"});
  const std::string merge = "Merge \"" + std::string(MESH_FILES) + "/l_shape_22.msh\";\n", comment = "/*\n" + mesh + "*/\n";
  for (const std::string ending : {".msh", ".geo", ".pos", ".opt", ".msh.opt", ".py", ""}) {
    for (const std::string& script : {command, comment + command, command + merge, mesh + command, "\n" + comment + command + merge}) {
      const Scratch file(script, ending);
      EXPECT_THROW(import(file.path()), core::InputError);
    }
    const Scratch commented("$Comments\n" + command + "$EndComments\n" + mesh, ending);
    EXPECT_EQ(import(commented.path()).finest().global_cells, 1);
  }
  const Scratch plain(mesh, ".msh"), options(command, ".msh.opt");
  import(plain.path());
  EXPECT_FALSE(std::filesystem::exists(witness.path()));
}

TEST(gmsh_file, that_is_no_regular_file_is_a_file_error) { EXPECT_THROW(import("/dev/zero"), core::FileError); }

}  // namespace thixis::mesh
