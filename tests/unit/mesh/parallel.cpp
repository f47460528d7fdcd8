#include <gtest/gtest.h>

#include <algorithm>

#include "meshes.hpp"
#include "thixis/mesh/check.hpp"
#include "thixis/mesh/geometry.hpp"

namespace thixis::mesh {
namespace {

/// The same mesh on one rank, where local numbers are ids.
void expect_part_of(const Mesh& part, const Mesh& whole) {
  ASSERT_EQ(part.global_cells, whole.cells);
  ASSERT_EQ(part.global_vertices, whole.vertices);
  ASSERT_EQ(part.global_faces, whole.faces);
  ASSERT_EQ(part.tags, whole.tags);
  const HostMesh p = on_host(part), w = on_host(whole);
  int wrong = 0;
  for (LocalIndex K = 0; K < part.cells; ++K)
    for (int i = 0; i < 3; ++i) {
      wrong += part.vertex_id[p.cell_vertices(K, i)] != w.cell_vertices(part.cell_id[K], i);
      wrong += part.face_id[p.cell_faces(K, i)] != w.cell_faces(part.cell_id[K], i);
    }
  for (LocalIndex v = 0; v < part.vertices; ++v)
    for (int d = 0; d < 2; ++d) {
      wrong += p.coordinates(v, d) != w.coordinates(part.vertex_id[v], d);
      wrong += p.parameter(v, d) != w.parameter(part.vertex_id[v], d);
    }
  for (LocalIndex F = 0; F < part.faces; ++F) {
    const GlobalIndex id = part.face_id[F];
    wrong += p.face_tag(F) != w.face_tag(id);
    for (int i = 0; i < 2; ++i) {
      wrong += part.vertex_id[p.face_vertices(F, i)] != w.face_vertices(id, i);
      wrong += p.face_cells(F, i) >= 0 && part.cell_id[p.face_cells(F, i)] != w.face_cells(id, i);
    }
  }
  EXPECT_EQ(wrong, 0);
}

void expect_parts_of(const Hierarchy& parts, const Hierarchy& whole) {
  ASSERT_EQ(parts.levels.size(), whole.levels.size());
  for (std::size_t j = 0; j < parts.levels.size(); ++j) expect_part_of(parts.levels[j], whole.levels[j]);
}

const std::vector<std::string> consistent;

}  // namespace

TEST(mesh_on_one_rank, has_local_numbers_equal_to_ids) {
  const core::Comm self(MPI_COMM_SELF);
  for (const Hierarchy& hierarchy : {criss_cross(2, 3, self), disk(2, 3, self)})
    for (const Mesh& mesh : hierarchy.levels) {
      for (LocalIndex K = 0; K < mesh.cells; ++K) EXPECT_EQ(mesh.cell_id[K], K);
      for (LocalIndex v = 0; v < mesh.vertices; ++v) EXPECT_EQ(mesh.vertex_id[v], v);
      for (LocalIndex F = 0; F < mesh.faces; ++F) EXPECT_EQ(mesh.face_id[F], F);
    }
}

TEST(partitioned_mesh, is_the_same_whatever_the_number_of_ranks_and_the_level_that_is_partitioned) {
  const core::Comm world, self(MPI_COMM_SELF);
  for (const int cells_per_rank : {1, 60, 500, 1000000}) {
    expect_parts_of(criss_cross(2, 4, world, cells_per_rank), criss_cross(2, 4, self));
    expect_parts_of(rectangle(2, 4, world, cells_per_rank), rectangle(2, 4, self));
    expect_parts_of(disk(2, 4, world, cells_per_rank), disk(2, 4, self));
  }
}

TEST(partitioned_mesh, is_consistent_on_all_levels) {
  for (const int cells_per_rank : {1, 60, 500, 1000000}) {
    EXPECT_EQ(check(criss_cross(2, 4, core::Comm(), cells_per_rank)), consistent);
    EXPECT_EQ(check(rectangle(2, 4, core::Comm(), cells_per_rank)), consistent);
    EXPECT_EQ(check(disk(2, 4, core::Comm(), cells_per_rank)), consistent);
  }
}

TEST(partitioned_mesh, is_consistent_with_ranks_that_have_no_cell) {
  MeshParams params;
  params.generator = Generator::rectangle;
  params.cells_per_side = 1;  // two cells
  params.refinements = 2;
  params.cells_per_rank = 1;
  const core::Comm world;
  EXPECT_EQ(check(build(params, world, ".")), consistent);
  params.refinements = 0;
  const Hierarchy coarse = build(params, world, ".");
  EXPECT_EQ(check(coarse), consistent);
  if (world.rank() >= 2) {
    EXPECT_EQ(coarse.finest().cells, 0);
  }
  const Mesh fine = refine(refine(coarse.finest()));
  EXPECT_EQ(check(fine), consistent);
  EXPECT_EQ(world.sum(static_cast<long long>(fine.owned_cells)), 32);
}

TEST(partitioned_mesh, has_parts_of_nearly_equal_size_with_few_ghosts) {
  const Mesh mesh = criss_cross(4, 3, core::Comm(), 300).finest();
  const double share = static_cast<double>(mesh.global_cells) / mesh.comm.size();
  EXPECT_NEAR(mesh.owned_cells, share, 0.1 * share);
  EXPECT_LT(mesh.cells, 2.5 * share);
}

TEST(partitioned_mesh, is_cut_down_at_the_coarsest_level_with_enough_cells_per_rank) {
  const core::Comm world;
  const Hierarchy hierarchy = criss_cross(4, 4, world, 64);  // 64, 256, 1024, ... cells
  std::size_t partitioned = 0;
  while (hierarchy.levels[partitioned].global_cells < 64 * world.size()) ++partitioned;
  for (std::size_t j = 0; j < partitioned; ++j) EXPECT_EQ(hierarchy.levels[j].cells, hierarchy.levels[j].global_cells);
  for (std::size_t j = partitioned; j < hierarchy.levels.size(); ++j) {
    const Mesh& mesh = hierarchy.levels[j];
    EXPECT_EQ(mesh.cells, hierarchy.levels[partitioned].cells << (2 * (j - partitioned)));
    if (world.size() > 2) {
      EXPECT_LT(world.min(mesh.cells), mesh.global_cells);
    }
  }
}

TEST(partitioned_mesh, is_the_same_when_built_again) {
  const Mesh first = disk(3, 3).finest(), second = disk(3, 3).finest();
  EXPECT_EQ(first.cell_id, second.cell_id);
  EXPECT_EQ(first.cell_owner, second.cell_owner);
}

TEST(partitioned_mesh, has_whole_patches_around_the_vertices_of_owned_cells) {
  const core::Comm self(MPI_COMM_SELF);
  for (const int cells_per_rank : {1, 100}) {
    const Hierarchy parts = criss_cross(2, 4, core::Comm(), cells_per_rank), whole = criss_cross(2, 4, self);
    for (std::size_t j = 0; j < parts.levels.size(); ++j) {
      const Mesh& part = parts.levels[j];
      const HostMesh p = on_host(part), w = on_host(whole.levels[j]);
      std::vector<int> cells_here(part.vertices, 0), cells_in_all(whole.levels[j].vertices, 0);
      for (LocalIndex K = 0; K < part.cells; ++K)
        for (int i = 0; i < 3; ++i) ++cells_here[p.cell_vertices(K, i)];
      for (LocalIndex K = 0; K < whole.levels[j].cells; ++K)
        for (int i = 0; i < 3; ++i) ++cells_in_all[w.cell_vertices(K, i)];
      for (LocalIndex K = 0; K < part.owned_cells; ++K)
        for (int i = 0; i < 3; ++i) {
          const LocalIndex v = p.cell_vertices(K, i);
          EXPECT_EQ(cells_here[v], cells_in_all[part.vertex_id[v]]);
        }
      for (LocalIndex v = 0; v < part.vertices; ++v)
        if (part.vertex_owner[v] == part.comm.rank()) {
          EXPECT_EQ(cells_here[v], cells_in_all[part.vertex_id[v]]);
        }
    }
  }
}

TEST(partitioned_mesh, has_an_owned_cell_at_every_owned_vertex_and_face) {
  for (const Mesh& mesh : disk(2, 4).levels) {
    const HostMesh host = on_host(mesh);
    std::vector<char> vertex(mesh.vertices, 0), face(mesh.faces, 0);
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int i = 0; i < 3; ++i) vertex[host.cell_vertices(K, i)] = face[host.cell_faces(K, i)] = 1;
    for (LocalIndex v = 0; v < mesh.vertices; ++v)
      if (mesh.vertex_owner[v] == mesh.comm.rank()) {
        EXPECT_TRUE(vertex[v]);
      }
    for (LocalIndex F = 0; F < mesh.faces; ++F)
      if (mesh.face_owner[F] == mesh.comm.rank()) {
        EXPECT_TRUE(face[F]);
      }
  }
}

}  // namespace thixis::mesh
