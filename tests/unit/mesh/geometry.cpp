#include "thixis/mesh/geometry.hpp"

#include <gtest/gtest.h>

#include "meshes.hpp"
#include "thixis/mesh/remoteness.hpp"
#include "thixis/mesh/statistics.hpp"

namespace thixis::mesh {

TEST(barycentric_gradients, sum_to_zero_and_reproduce_linear_functions) {
  const Mesh mesh = disk(2, 1).finest();
  const HostMesh host = on_host(mesh);
  for (LocalIndex K = 0; K < mesh.cells; ++K) {
    const CellGeometry cell = cell_geometry(host.coordinates, host.cell_vertices, K);
    double gradient[2] = {0, 0}, sum[2] = {0, 0};
    for (int i = 0; i < 3; ++i) {
      const LocalIndex v = host.cell_vertices(K, i);
      for (int d = 0; d < 2; ++d) {
        sum[d] += cell.gradient[i][d];
        gradient[d] += (3 * host.coordinates(v, 0) - 2 * host.coordinates(v, 1) + 1) * cell.gradient[i][d];
      }
    }
    EXPECT_NEAR(sum[0], 0, 1e-12);
    EXPECT_NEAR(sum[1], 0, 1e-12);
    EXPECT_NEAR(gradient[0], 3, 1e-12);
    EXPECT_NEAR(gradient[1], -2, 1e-12);
  }
}

TEST(face_normals, times_sign_and_length_are_minus_twice_the_area_times_the_gradient_opposite) {
  const Mesh mesh = disk(2, 2).finest();
  const HostMesh host = on_host(mesh);
  for (LocalIndex K = 0; K < mesh.cells; ++K) {
    const CellGeometry cell = cell_geometry(host.coordinates, host.cell_vertices, K);
    for (int i = 0; i < 3; ++i) {
      const LocalIndex F = host.cell_faces(K, i);
      const FaceGeometry face = face_geometry(host.coordinates, host.face_vertices, F);
      EXPECT_EQ(local_face(host.cell_faces, K, F), i);
      for (int d = 0; d < 2; ++d)
        EXPECT_NEAR(normal_sign(host.face_cells, F, K) * face.normal[d] * face.length, -2 * cell.area * cell.gradient[i][d], 1e-14);
    }
  }
}

TEST(face_normals, point_from_the_first_to_the_second_cell) {
  const Mesh mesh = criss_cross(3, 1).finest();
  const HostMesh host = on_host(mesh);
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    const LocalIndex K = host.face_cells(F, 0), L = host.face_cells(F, 1);
    EXPECT_EQ(first_cell(host.face_cells, F), K >= 0 ? K : L);
    if (K < 0 || L < 0) continue;
    EXPECT_EQ(neighbour(host.face_cells, F, K), L);
    EXPECT_EQ(neighbour(host.face_cells, F, L), K);
    const FaceGeometry face = face_geometry(host.coordinates, host.face_vertices, F);
    double along = 0;
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d)
        along += face.normal[d] * (host.coordinates(host.cell_vertices(L, i), d) - host.coordinates(host.cell_vertices(K, i), d));
    EXPECT_GT(along, 0);
  }
}

TEST(disk_chart, maps_the_sides_of_the_hexagon_to_the_circle_at_constant_speed) {
  const double h = std::sqrt(0.75), corner[7][2] = {{1, 0}, {0.5, h}, {-0.5, h}, {-1, 0}, {-0.5, -h}, {0.5, -h}, {1, 0}};
  for (int side = 0; side < 6; ++side)
    for (const double t : {0.0, 0.1, 0.5, 0.75, 1.0})
      for (const double radius : {1e-3, 0.5, 1.0}) {
        const Point p = physical(Chart::disk, {radius * ((1 - t) * corner[side][0] + t * corner[side + 1][0]),
                                               radius * ((1 - t) * corner[side][1] + t * corner[side + 1][1])});
        EXPECT_NEAR(p.x, radius * std::cos((side + t) * M_PI / 3), 1e-15);
        EXPECT_NEAR(p.y, radius * std::sin((side + t) * M_PI / 3), 1e-15);
      }
  const Point centre = physical(Chart::disk, {0, 0});
  EXPECT_EQ(centre.x, 0);
  EXPECT_EQ(centre.y, 0);
}

TEST(statistics, of_a_criss_cross_mesh_are_those_of_its_triangles) {
  const Statistics s = statistics(criss_cross(4, 2).finest());
  EXPECT_NEAR(s.area, 1, 1e-13);
  EXPECT_NEAR(s.h_min, 1.0 / 16, 1e-14);
  EXPECT_NEAR(s.h_max, 1.0 / 16, 1e-14);
  EXPECT_NEAR(s.smallest_angle, M_PI / 4, 1e-12);
  EXPECT_NEAR(s.largest_angle, M_PI / 2, 1e-12);
}

TEST(statistics, of_a_coarse_disk_are_those_of_the_hexagon) {
  const Statistics s = statistics(disk(1, 0).finest());
  EXPECT_NEAR(s.area, 1.5 * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(s.h_max, 1, 1e-14);
  EXPECT_NEAR(s.smallest_angle, M_PI / 3, 1e-12);
}

TEST(bounding_box, is_that_of_all_ranks) {
  const Box box = bounding_box(rectangle(3, 1).finest());
  EXPECT_EQ(box.lower[0], -1);
  EXPECT_EQ(box.lower[1], 0.5);
  EXPECT_EQ(box.upper[0], 2);
  EXPECT_EQ(box.upper[1], 2);
  EXPECT_EQ(box.side(1), 1.5);
  EXPECT_NEAR(box.diagonal(), std::hypot(3, 1.5), 1e-15);
}

TEST(remoteness, is_the_distance_from_the_origin_in_widths_in_any_unit_order_and_direction) {
  const auto of = [](double x, double y, double unit, int first) {
    const double points[3][2] = {{x, y}, {x + 2, y}, {x, y + 0.5}};
    return remoteness(3, [&](int i, int d) { return unit * points[(i + first) % 3][d]; });
  };
  for (int first = 0; first < 3; ++first)
    for (const double unit : {1.0, 1e-9, -1e6}) {
      EXPECT_NEAR(of(1000, 7, unit, first), 501, 1e-9);
      EXPECT_NEAR(of(-1000, 7, unit, first), 500, 1e-9);
      EXPECT_NEAR(of(3, -4000, unit, first), 2000, 1e-9);
      EXPECT_NEAR(of(-1, 0, unit, first), 0.5, 1e-12);
    }
  EXPECT_EQ(remoteness(2, [](int, int) { return 5.0; }), 0);
}

}  // namespace thixis::mesh
