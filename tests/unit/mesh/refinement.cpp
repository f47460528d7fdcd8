#include <gtest/gtest.h>

#include <numeric>

#include "meshes.hpp"
#include "thixis/mesh/check.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/statistics.hpp"

namespace thixis::mesh {
namespace {

void expect_same(const Mesh& refined, const Mesh& generated) {
  const PlainMesh a(refined), b(generated);
  EXPECT_EQ(a.triangles.size(), static_cast<std::size_t>(refined.global_cells));
  EXPECT_EQ(a.points.size(), static_cast<std::size_t>(refined.global_vertices));
  EXPECT_EQ(refined.global_faces, generated.global_faces);
  EXPECT_LT(a.distance(b), 1e-14);
  EXPECT_EQ(a.triangles, b.triangles);
}

/// Number of vertices on no face of the boundary, over all ranks.
GlobalIndex interior_vertices(const Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  std::vector<char> interior(mesh.vertices, 1);
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    if (host.face_tag(F) >= 0) interior[host.face_vertices(F, 0)] = interior[host.face_vertices(F, 1)] = 0;
  long long count = 0;
  for (LocalIndex v = 0; v < mesh.vertices; ++v) count += mesh.vertex_owner[v] == mesh.comm.rank() && interior[v];
  return mesh.comm.sum(count);
}

}  // namespace

TEST(criss_cross_mesh, has_64_times_4_to_the_j_cells_and_25_interior_vertices_on_the_coarsest_level) {
  const Hierarchy hierarchy = criss_cross(4, 4);
  ASSERT_EQ(hierarchy.levels.size(), 5u);
  GlobalIndex cells = 64, side = 4;
  for (const Mesh& mesh : hierarchy.levels) {
    EXPECT_EQ(mesh.global_cells, cells);
    EXPECT_EQ(mesh.global_vertices, (side + 1) * (side + 1) + side * side);
    EXPECT_EQ(mesh.global_vertices - mesh.global_faces + mesh.global_cells, 1);  // Euler
    EXPECT_EQ(mesh.comm.sum(static_cast<long long>(mesh.owned_cells)), cells);
    cells *= 4, side *= 2;
  }
  EXPECT_EQ(interior_vertices(hierarchy.levels[0]), 25);
}

TEST(criss_cross_mesh, refines_to_the_one_with_twice_the_squares) {
  const Hierarchy hierarchy = criss_cross(3, 3);
  for (int j = 0; j <= 3; ++j) expect_same(hierarchy.levels[j], criss_cross(3 << j, 0).finest());
}

TEST(criss_cross_mesh, keeps_the_right_angle_at_vertex_0) {
  for (const Mesh& mesh : criss_cross(2, 3).levels) {
    const HostMesh host = on_host(mesh);
    for (LocalIndex K = 0; K < mesh.cells; ++K) {
      const CellGeometry cell = cell_geometry(host.coordinates, host.cell_vertices, K);
      EXPECT_NEAR(cell.gradient[1][0] * cell.gradient[2][0] + cell.gradient[1][1] * cell.gradient[2][1], 0, 1e-12);
    }
  }
}

TEST(rectangle_mesh, refines_to_the_one_with_twice_the_squares) {
  const Hierarchy hierarchy = rectangle(2, 3);
  EXPECT_EQ(hierarchy.levels[0].global_cells, 2 * 2 * 4);
  for (int j = 0; j <= 3; ++j) expect_same(hierarchy.levels[j], rectangle(2 << j, 0).finest());
}

TEST(disk_mesh, has_6_N_squared_cells_and_rings_of_6k_vertices) {
  const int N = 5;
  const Mesh mesh = disk(N, 0).finest();
  EXPECT_EQ(mesh.global_cells, 6 * N * N);
  std::vector<int> on_ring(N + 1, 0);
  for (const auto& [key, point] : PlainMesh(mesh).points) {
    const double ring = N * std::hypot(point[0], point[1]);
    const int k = static_cast<int>(std::lround(ring));
    EXPECT_NEAR(ring, k, 1e-13);
    ++on_ring[k];
    if (k == 0) continue;
    const double position = 6 * k * std::atan2(point[1], point[0]) / (2 * M_PI);
    EXPECT_NEAR(position, std::round(position), 1e-12);
  }
  EXPECT_EQ(on_ring, (std::vector<int>{1, 6, 12, 18, 24, 30}));
}

TEST(disk_mesh, refines_to_the_one_with_twice_the_rings) {
  for (const int rings : {1, 3}) {
    const Hierarchy hierarchy = disk(rings, 3);
    for (int j = 0; j <= 3; ++j) expect_same(hierarchy.levels[j], disk(rings << j, 0).finest());
  }
}

TEST(disk_mesh, has_its_boundary_on_the_circle_at_all_levels) {
  for (const Mesh& mesh : disk(2, 5).levels) {
    const HostMesh host = on_host(mesh);
    long long faces = 0;
    for (LocalIndex F = 0; F < mesh.faces; ++F) {
      if (host.face_tag(F) < 0) continue;
      EXPECT_EQ(mesh.tags[host.face_tag(F)], "circle");
      faces += mesh.face_owner[F] == mesh.comm.rank() ? 1 : 0;
      for (int i = 0; i < 2; ++i) {
        const LocalIndex v = host.face_vertices(F, i);
        EXPECT_NEAR(std::hypot(host.coordinates(v, 0), host.coordinates(v, 1)), 1, 1e-15);
      }
    }
    EXPECT_EQ(mesh.comm.sum(faces) * mesh.comm.sum(faces), 6 * mesh.global_cells);  // 6 N faces, 6 N^2 cells
  }
}

TEST(disk_mesh, stays_shape_regular) {
  const Hierarchy hierarchy = disk(1, 6);
  const Statistics finest = statistics(hierarchy.finest());
  EXPECT_GT(finest.smallest_angle, 0.5);
  EXPECT_NEAR(finest.area, M_PI, 2e-3);
  EXPECT_LT(finest.area, M_PI);
}

TEST(refinement, makes_children_that_fill_their_parents_and_vertices_on_midpoints) {
  const std::vector<std::string> consistent;
  EXPECT_EQ(check(criss_cross(2, 4)), consistent);
  EXPECT_EQ(check(rectangle(2, 4)), consistent);
  EXPECT_EQ(check(disk(2, 4)), consistent);
}

TEST(refinement, gives_straight_children_the_area_of_their_parent_each_a_quarter) {
  for (const Hierarchy& hierarchy : {criss_cross(2, 3), rectangle(1, 3)})
    for (std::size_t j = 1; j < hierarchy.levels.size(); ++j) {
      const HostMesh coarse = on_host(hierarchy.levels[j - 1]), fine = on_host(hierarchy.levels[j]);
      for (LocalIndex K = 0; K < hierarchy.levels[j].cells; ++K)
        EXPECT_NEAR(4 * cell_area(fine.coordinates, fine.cell_vertices, K) /
                        cell_area(coarse.coordinates, coarse.cell_vertices, hierarchy.levels[j].cell_parent[K]),
                    1, 1e-13);
    }
}

TEST(refinement, inherits_the_tags_of_the_boundary) {
  for (const Mesh& mesh : rectangle(1, 3).levels) {
    const HostMesh host = on_host(mesh);
    std::map<std::string, double> length;
    for (LocalIndex F = 0; F < mesh.faces; ++F) {
      if (host.face_tag(F) < 0 || mesh.face_owner[F] != mesh.comm.rank()) continue;
      const FaceGeometry face = face_geometry(host.coordinates, host.face_vertices, F);
      const std::string& tag = mesh.tags[host.face_tag(F)];
      length[tag] += face.length;
      if (tag == "left") {
        EXPECT_EQ(face.midpoint[0], -1);
      }
      if (tag == "right") {
        EXPECT_EQ(face.midpoint[0], 2);
      }
      if (tag == "bottom") {
        EXPECT_EQ(face.midpoint[1], 0.5);
      }
      if (tag == "top") {
        EXPECT_EQ(face.midpoint[1], 2);
      }
    }
    for (const std::string side : {"left", "right"}) EXPECT_NEAR(mesh.comm.sum(length[side]), 1.5, 1e-14);
    for (const std::string side : {"bottom", "top"}) EXPECT_NEAR(mesh.comm.sum(length[side]), 3, 1e-14);
  }
}

}  // namespace thixis::mesh
