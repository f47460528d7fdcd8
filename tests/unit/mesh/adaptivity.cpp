#include <gtest/gtest.h>

#include <functional>

#include "lineage.hpp"
#include "meshes.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/adapt.hpp"
#include "thixis/mesh/check.hpp"
#include "thixis/mesh/statistics.hpp"

namespace thixis::mesh {
namespace {

const std::vector<std::string> consistent;

using Triangle = std::array<std::array<double, 2>, 3>;
using Marks = std::function<bool(const Triangle&)>;

Triangle triangle(const HostMesh& host, LocalIndex K) {
  Triangle corners;
  for (int i = 0; i < 3; ++i)
    for (int d = 0; d < 2; ++d) corners[i][d] = host.coordinates(host.cell_vertices(K, i), d);
  return corners;
}

std::vector<LocalIndex> marked_cells(const Mesh& mesh, const Marks& marks) {
  const HostMesh host = on_host(mesh);
  std::vector<LocalIndex> cells;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    if (marks(triangle(host, K))) cells.push_back(K);
  return cells;
}

void adapt_times(Hierarchy& hierarchy, int times, const Marks& marks) {
  for (int k = 0; k < times; ++k) adapt(hierarchy, marked_cells(hierarchy.finest(), marks));
}

/// Cells that have the point, with a little around.
Marks at_point(double x, double y) {
  return [=](const Triangle& corner) {
    for (int i = 0; i < 3; ++i) {
      const auto &a = corner[i], &b = corner[(i + 1) % 3];
      if ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) < -1e-12) return false;
    }
    return true;
  };
}

/// Cells that the circle around (x, y) cuts.
Marks on_circle(double x, double y, double radius) {
  return [=](const Triangle& corner) {
    int inside = 0;
    for (const auto& a : corner) inside += std::hypot(a[0] - x, a[1] - y) < radius ? 1 : 0;
    return inside == 1 || inside == 2;
  };
}

Hierarchy gmsh(const core::Comm& comm = core::Comm()) {
  MeshParams params;
  params.generator = Generator::file;
  params.file = "l_shape_22.msh";
  params.cells_per_rank = 20;
  params.refinements = 1;
  return build(params, comm, MESH_FILES);
}

struct Case {
  Hierarchy hierarchy;
  Marks marks;
};
std::vector<Case> cases(const core::Comm& comm = core::Comm()) {
  return {{criss_cross(2, 1, comm, 8), on_circle(0.4, 0.3, 0.31)},
          {criss_cross(2, 3, comm, 20), at_point(0.3, 0.7)},
          {rectangle(1, 2, comm, 20), on_circle(0, 1, 0.8)},
          {disk(2, 1, comm, 12), on_circle(0.9, 0, 0.6)},
          {disk(1, 0, comm, 12), at_point(0.1, 0.05)},
          {gmsh(comm), at_point(0, 0)}};
}

/// On one rank, where local numbers are ids.
void expect_part_of(const Mesh& part, const Mesh& whole) {
  ASSERT_EQ(part.global_cells, whole.cells);
  ASSERT_EQ(part.global_vertices, whole.vertices);
  ASSERT_EQ(part.global_faces, whole.faces);
  const HostMesh p = on_host(part), w = on_host(whole);
  int wrong = 0;
  for (LocalIndex K = 0; K < part.cells; ++K) {
    wrong += !part.cell_parent_id.empty() && part.cell_parent_id[K] != whole.cell_parent_id[part.cell_id[K]];
    wrong += !part.cell_shape.empty() && part.cell_shape[K] != whole.cell_shape[part.cell_id[K]];
    for (int i = 0; i < 3; ++i) {
      wrong += part.vertex_id[p.cell_vertices(K, i)] != w.cell_vertices(part.cell_id[K], i);
      wrong += part.face_id[p.cell_faces(K, i)] != w.cell_faces(part.cell_id[K], i);
    }
  }
  for (LocalIndex v = 0; v < part.vertices; ++v)
    for (int d = 0; d < 2; ++d) wrong += p.coordinates(v, d) != w.coordinates(part.vertex_id[v], d);
  for (LocalIndex F = 0; F < part.faces; ++F) {
    wrong += p.face_tag(F) != w.face_tag(part.face_id[F]);
    for (int i = 0; i < 2; ++i) wrong += part.vertex_id[p.face_vertices(F, i)] != w.face_vertices(part.face_id[F], i);
  }
  EXPECT_EQ(wrong, 0);
}

/// Ids of cells on all ranks whose corners are marked.
std::vector<GlobalIndex> all_marked(const Mesh& mesh, const Marks& marks) {
  std::vector<GlobalIndex> ids;
  for (const LocalIndex K : marked_cells(mesh, marks)) ids.push_back(mesh.cell_id[K]);
  return mesh.comm.gather(ids);
}

}  // namespace

TEST(adaptive_mesh, is_conforming_with_children_that_fill_their_parents) {
  for (auto& [hierarchy, marks] : cases()) {
    adapt_times(hierarchy, 5, marks);
    EXPECT_EQ(check(hierarchy), consistent);
  }
}

TEST(adaptive_mesh, is_the_same_on_any_number_of_ranks) {
  auto alone = cases(core::Comm(MPI_COMM_SELF)), together = cases();
  for (std::size_t k = 0; k < alone.size(); ++k) {
    adapt_times(alone[k].hierarchy, 5, alone[k].marks);
    adapt_times(together[k].hierarchy, 5, together[k].marks);
    ASSERT_EQ(alone[k].hierarchy.levels.size(), together[k].hierarchy.levels.size());
    for (std::size_t j = 0; j < alone[k].hierarchy.levels.size(); ++j)
      expect_part_of(together[k].hierarchy.levels[j], alone[k].hierarchy.levels[j]);
  }
}

TEST(adaptive_mesh, cuts_marked_cells_into_four) {
  for (auto& [hierarchy, marks] : cases())
    for (int k = 0; k < 3; ++k) {
      const Mesh& coarse = hierarchy.finest();
      const auto marked = all_marked(coarse, marks);
      ASSERT_FALSE(marked.empty());
      adapt_times(hierarchy, 1, marks);
      std::vector<int> children(coarse.global_cells, 0);
      for (LocalIndex K = 0; K < hierarchy.finest().owned_cells; ++K) ++children[hierarchy.finest().cell_parent_id[K]];
      coarse.comm.sum(children);
      for (const GlobalIndex id : marked) EXPECT_EQ(children[id], 4);
      EXPECT_EQ(*std::min_element(children.begin(), children.end()), 1);  // far from the marks
    }
}

TEST(adaptive_mesh, with_no_mark_is_the_mesh_as_it_is) {
  for (auto& [hierarchy, marks] : cases()) {
    adapt(hierarchy, {});
    const auto &coarse = hierarchy.levels[hierarchy.levels.size() - 2], &fine = hierarchy.finest();
    EXPECT_EQ(fine.global_cells, coarse.global_cells);
    EXPECT_EQ(PlainMesh(fine).triangles, PlainMesh(coarse).triangles);
    for (LocalIndex K = 0; K < fine.cells; ++K) EXPECT_EQ(fine.cell_shape[K], 0);
  }
}

TEST(adaptive_mesh, with_all_cells_marked_is_the_uniform_refinement_of_newest_vertex_meshes) {
  Hierarchy adaptive = criss_cross(2, 1);
  adapt_times(adaptive, 2, [](const Triangle&) { return true; });
  const Hierarchy uniform = criss_cross(2, 3, core::Comm(MPI_COMM_SELF));
  for (int j = 0; j <= 3; ++j) expect_part_of(adaptive.levels[j], uniform.levels[j]);
}

TEST(adaptive_mesh, keeps_the_area_and_its_angles_over_12_levels_towards_points_and_curves) {
  for (auto& [hierarchy, marks] : cases()) {
    const bool round = hierarchy.finest().chart == Chart::disk;
    const Statistics before = statistics(hierarchy.finest());
    adapt_times(hierarchy, 12, marks);
    const Statistics after = statistics(hierarchy.finest());
    if (round) EXPECT_LT(after.area, M_PI);
    else EXPECT_NEAR(after.area / before.area, 1, 1e-12);
    // Bisection halves angles at most twice; the chart of the disk bends by a bounded factor.
    EXPECT_GT(after.smallest_angle, 0.45 * before.smallest_angle * (round ? 0.7 : 1));
    EXPECT_LT(after.h_min, before.h_min / 1000);
  }
}

TEST(adaptive_mesh, of_the_disk_has_its_boundary_on_the_circle) {
  Hierarchy hierarchy = disk(2, 0);
  adapt_times(hierarchy, 5, at_point(std::cos(0.3), std::sin(0.3) - 1e-3));
  const HostMesh host = on_host(hierarchy.finest());
  for (LocalIndex F = 0; F < hierarchy.finest().faces; ++F)
    for (int i = 0; i < 2 && host.face_tag(F) >= 0; ++i) {
      const LocalIndex v = host.face_vertices(F, i);
      EXPECT_NEAR(std::hypot(host.coordinates(v, 0), host.coordinates(v, 1)), 1, 1e-15);
    }
}

TEST(adaptive_mesh, keeps_ids_of_vertices_and_references_to_levels) {
  Hierarchy hierarchy = disk(2, 1);
  const Mesh &first = hierarchy.levels[0], &coarse = hierarchy.levels[1];
  adapt_times(hierarchy, 4, on_circle(0, 0, 0.5));
  EXPECT_EQ(&first, &hierarchy.levels[0]);
  EXPECT_EQ(first.global_cells, 24);
  std::map<GlobalIndex, std::array<double, 2>> place;
  const HostMesh above = on_host(coarse), host = on_host(hierarchy.finest());
  for (LocalIndex v = 0; v < coarse.vertices; ++v) place[coarse.vertex_id[v]] = {above.coordinates(v, 0), above.coordinates(v, 1)};
  for (LocalIndex v = 0; v < hierarchy.finest().vertices; ++v)
    if (const auto old = place.find(hierarchy.finest().vertex_id[v]); old != place.end()) {
      EXPECT_EQ(old->second, (std::array<double, 2>{host.coordinates(v, 0), host.coordinates(v, 1)}));
    }
}

TEST(adaptive_mesh, of_a_copied_hierarchy_leaves_the_original_as_it_is) {
  Hierarchy first = criss_cross(2, 1, core::Comm(), 8);
  adapt_times(first, 2, at_point(0.3, 0.7));
  Hierarchy second = first;
  adapt_times(second, 2, at_point(0.9, 0.1));
  adapt_times(first, 2, at_point(0.3, 0.7));
  Hierarchy expected = criss_cross(2, 1, core::Comm(MPI_COMM_SELF));
  adapt_times(expected, 4, at_point(0.3, 0.7));
  for (int j = 0; j <= 5; ++j) expect_part_of(first.levels[j], expected.levels[j]);
}

TEST(adaptive_mesh, is_shared_out_to_the_ranks_in_nearly_equal_parts) {
  Hierarchy hierarchy = criss_cross(8, 0);  // trees of 256 cells
  bool moved = false;
  for (int k = 0; k < 5; ++k) {
    const Mesh& coarse = hierarchy.finest();
    adapt_times(hierarchy, 1, on_circle(0.2, 0.2, 0.15));
    const Mesh& mesh = hierarchy.finest();
    const double share = static_cast<double>(mesh.global_cells) / mesh.comm.size();
    EXPECT_LT(mesh.comm.max(mesh.owned_cells), 1.2 * share);
    EXPECT_GT(mesh.comm.min(mesh.owned_cells), 0.8 * share);
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K) moved = moved || mesh.cell_parent[K] < 0 || mesh.cell_parent[K] >= coarse.owned_cells;
  }
  EXPECT_EQ(hierarchy.finest().comm.any(moved), hierarchy.finest().comm.size() > 1);
}

TEST(adaptive_mesh, stays_where_it_is_while_the_parts_are_nearly_equal) {
  Hierarchy hierarchy = criss_cross(8, 3);
  const Mesh& coarse = hierarchy.finest();
  adapt_times(hierarchy, 1, at_point(0.5, 0.5));
  const Mesh& mesh = hierarchy.finest();
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    ASSERT_GE(mesh.cell_parent[K], 0);
    EXPECT_LT(mesh.cell_parent[K], coarse.owned_cells);
  }
}

TEST(adaptive_mesh, can_grow_from_a_mesh_with_fewer_cells_than_ranks) {
  MeshParams params;
  params.generator = Generator::rectangle;
  params.cells_per_side = 1;
  Hierarchy hierarchy = build(params, core::Comm(), ".");
  adapt_times(hierarchy, 4, at_point(0, 0));
  EXPECT_EQ(check(hierarchy), consistent);
}

TEST(ancestry, of_adaptive_levels_sums_the_areas_of_children_up_to_those_of_the_root) {
  for (auto& [hierarchy, marks] : cases()) {
    adapt_times(hierarchy, 4, marks);
    for (int level = 0; level < static_cast<int>(hierarchy.levels.size()); ++level) expect_lineage(hierarchy, level);
  }
}

TEST(check, finds_wrong_parents_and_shapes_of_adaptive_levels) {
  Hierarchy hierarchy = criss_cross(2, 1, core::Comm(), 8);
  adapt_times(hierarchy, 2, at_point(0.3, 0.7));
  ASSERT_EQ(check(hierarchy), consistent);
  Mesh& mesh = hierarchy.levels.back();
  if (mesh.comm.root()) mesh.cell_parent_id[0] = mesh.cell_parent_id[0] == 0 ? 1 : 0;
  auto found = check(hierarchy);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].substr(0, 42), "level 3: cells whose parent has another id");
  EXPECT_EQ(found.back(), "level 3: parents that their children do not fill: 2");
}

}  // namespace thixis::mesh
