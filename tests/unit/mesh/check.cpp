#include "thixis/mesh/check.hpp"

#include <gtest/gtest.h>

#include "meshes.hpp"

namespace thixis::mesh {
namespace {

/// A consistent mesh to spoil: private copies of the Views.
Mesh fresh() {
  Mesh mesh = criss_cross(2, 2).finest();
  EXPECT_TRUE(check(mesh).empty());
  return mesh;
}

/// The sentences of check begin with these words, in this order.
void expect_found(const Mesh& mesh, const std::vector<std::string>& words) {
  const std::vector<std::string> found = check(mesh);
  ASSERT_EQ(found.size(), words.size()) << ::testing::PrintToString(found);
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k].substr(0, words[k].size()), words[k]);
}

}  // namespace

TEST(check, finds_a_vertex_moved_across_its_patch) {
  Mesh mesh = fresh();
  HostMesh host = on_host(mesh);
  if (mesh.comm.root()) host.coordinates(host.cell_vertices(0, 0), 0) += 10;
  commit(host, mesh);
  expect_found(mesh, {"cells that are not counter-clockwise"});
}

TEST(check, finds_exchanged_faces) {
  Mesh mesh = fresh();
  HostMesh host = on_host(mesh);
  if (mesh.comm.root()) std::swap(host.cell_faces(0, 0), host.cell_faces(0, 1));
  commit(host, mesh);
  expect_found(mesh, {"cells whose faces are not opposite their vertices"});
}

TEST(check, finds_exchanged_cells_of_a_face) {
  Mesh mesh = fresh();
  HostMesh host = on_host(mesh);
  if (mesh.comm.root()) std::swap(host.face_cells(host.cell_faces(0, 0), 0), host.face_cells(host.cell_faces(0, 0), 1));
  commit(host, mesh);
  expect_found(mesh, {"cells whose faces are not opposite their vertices"});
}

TEST(check, finds_a_missing_tag) {
  Mesh mesh = fresh();
  HostMesh host = on_host(mesh);
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    if (mesh.face_owner[F] == mesh.comm.rank()) host.face_tag(F) = -1;
  commit(host, mesh);
  expect_found(mesh, {"faces of needed patches that lack a cell"});
}

TEST(check, finds_a_tag_inside) {
  Mesh mesh = fresh();
  HostMesh host = on_host(mesh);
  Kokkos::deep_copy(host.face_tag, 0);
  commit(host, mesh);
  expect_found(mesh, {"faces with a tag that have two cells"});
}

TEST(check, finds_a_number_out_of_range) {
  Mesh mesh = fresh();
  HostMesh host = on_host(mesh);
  if (mesh.comm.root()) host.cell_vertices(0, 2) = mesh.vertices;
  commit(host, mesh);
  expect_found(mesh, {"cells with numbers of vertices or faces out of range"});
}

TEST(check, finds_an_entity_without_owner) {
  Mesh mesh = fresh();
  if (mesh.comm.root()) mesh.vertex_owner[0] = mesh.comm.size();
  const std::vector<std::string> found = check(mesh);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.back().substr(0, 42), "ids of vertices without exactly one owner:");
}

TEST(check, finds_an_id_used_twice) {
  Mesh mesh = fresh();
  if (mesh.comm.root()) mesh.cell_id[0] = mesh.cell_id[1];
  const std::vector<std::string> found = check(mesh);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].substr(0, 39), "ids of cells without exactly one owner:");
}

TEST(check, finds_a_wrong_parent) {
  Hierarchy hierarchy = criss_cross(2, 2);
  ASSERT_TRUE(check(hierarchy).empty());
  if (hierarchy.finest().comm.root()) std::swap(hierarchy.levels[2].cell_parent[0], hierarchy.levels[2].cell_parent[4]);
  const std::vector<std::string> found = check(hierarchy);
  ASSERT_GE(found.size(), 2u);
  EXPECT_EQ(found[0], "level 2: cells whose parent has another id: 2");
  EXPECT_EQ(found[1], "level 2: parents that their children do not fill: 2");
}

TEST(check, finds_a_vertex_off_the_midpoint_of_its_parents) {
  Hierarchy hierarchy = criss_cross(2, 2);
  Mesh& mesh = hierarchy.levels[2];
  HostMesh host = on_host(mesh);
  if (mesh.comm.root()) host.parameter(mesh.vertices - 1, 0) += 1e-9;
  commit(host, mesh);
  const std::vector<std::string> found = check(hierarchy);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.back(), "level 2: vertices that are not the midpoint of their parents: 1");
}

}  // namespace thixis::mesh
