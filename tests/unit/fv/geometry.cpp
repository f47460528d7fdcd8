#include "grids.hpp"

namespace thixis::fv {
namespace {

class Geometry : public ::testing::TestWithParam<Sample> {
 protected:
  const core::Comm comm;
  const Grid grid = GetParam().make(comm);
  const HostGrid at = on_host(grid);

  /// +1 where the normal of F points out of K.
  int sign(LocalIndex F, LocalIndex K) const { return at.face_cells(F, 0) == K ? 1 : -1; }
};

std::string title(const ::testing::TestParamInfo<Sample>& info) {
  std::string text;
  for (const char c : info.param.name) text += c == ' ' ? '_' : c == ',' ? 'x' : c;
  return text;
}

}  // namespace

TEST_P(Geometry, volumes_add_up_to_the_domain) {
  double volume = 0;
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) volume += at.volume(K);
  EXPECT_NEAR(comm.sum(volume), GetParam().volume, 1e-12);
  EXPECT_EQ(grid.global_cells, GetParam().cells);
  EXPECT_EQ(comm.sum(static_cast<long long>(grid.owned_cells)), grid.global_cells);
}

TEST_P(Geometry, faces_of_a_cell_close_it) {
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
    double sum[2] = {0, 0}, volume = 0;
    for (LocalIndex k = at.cell_face_begin(K); k < at.cell_face_begin(K + 1); ++k) {
      const LocalIndex F = at.cell_faces(k);
      ASSERT_TRUE(at.face_cells(F, 0) == K || at.face_cells(F, 1) == K);
      double outward = 0;
      for (int d = 0; d < 2; ++d) {
        const double n = sign(F, K) * at.face_normal(F, d);
        sum[d] += at.face_area(F) * n;
        outward += (at.face_centre(F, d) - at.barycentre(K, d)) * n;
      }
      EXPECT_GT(outward, 0);
      volume += at.face_area(F) * outward / grid.dimension;  // |K| = 1/d Σ |F| (x_F - x)·n
    }
    EXPECT_NEAR(sum[0], 0, 1e-14);
    EXPECT_NEAR(sum[1], 0, 1e-14);
    EXPECT_NEAR(volume, at.volume(K), 1e-14);
  }
}

TEST_P(Geometry, the_line_of_the_centres_is_orthogonal_to_the_face) {
  for (LocalIndex F = 0; F < grid.faces; ++F) {
    const LocalIndex K = at.face_cells(F, 0), L = at.face_cells(F, 1);
    EXPECT_EQ(L < 0, at.face_tag(F) >= 0);
    EXPECT_TRUE(L < 0 || grid.cell_id[K] < grid.cell_id[L]);
    EXPECT_GT(at.face_distance(F), 0);
    const double n[2] = {at.face_normal(F, 0), at.face_normal(F, 1)};
    EXPECT_NEAR(std::hypot(n[0], n[1]), 1, 1e-15);
    // Both centres project onto the same point of the face: its midpoint.
    for (const LocalIndex cell : {K, L}) {
      if (cell < 0) continue;
      const double x = at.centre(cell, 0) - at.face_centre(F, 0), y = at.centre(cell, 1) - at.face_centre(F, 1);
      EXPECT_NEAR(x * n[1] - y * n[0], 0, 1e-13);
    }
    const double to[2] = {L < 0 ? at.face_centre(F, 0) : at.centre(L, 0), L < 0 ? at.face_centre(F, 1) : at.centre(L, 1)};
    EXPECT_NEAR(std::hypot(to[0] - at.centre(K, 0), to[1] - at.centre(K, 1)), at.face_distance(F), 1e-13);
  }
}

TEST_P(Geometry, two_point_fluxes_of_affine_functions_are_exact) {
  const auto u = [](double x, double y) { return 0.3 + 2 * x - 0.7 * y; };
  const double gradient[2] = {2, grid.dimension == 1 ? 0 : -0.7};
  for (LocalIndex F = 0; F < grid.faces; ++F) {
    const LocalIndex K = at.face_cells(F, 0), L = at.face_cells(F, 1);
    const double here = u(at.centre(K, 0), at.centre(K, 1));
    const double there = L < 0 ? u(at.face_centre(F, 0), at.face_centre(F, 1)) : u(at.centre(L, 0), at.centre(L, 1));
    const double exact = at.face_area(F) * (gradient[0] * at.face_normal(F, 0) + gradient[1] * at.face_normal(F, 1));
    EXPECT_NEAR(at.face_area(F) / at.face_distance(F) * (there - here), exact, 1e-12);
  }
}

TEST_P(Geometry, corners_run_counter_clockwise_and_diameters_are_largest_distances) {
  const int n = grid.corners();
  ASSERT_EQ(n, grid.dimension == 1 ? 2 : GetParam().name == "triangles" ? 3 : 4);
  for (LocalIndex K = 0; K < grid.cells; ++K) {
    double twice = 0, largest = 0, mean[2] = {0, 0};
    for (int i = 0; i < n; ++i) {
      const LocalIndex a = at.cell_vertices(K, i), b = at.cell_vertices(K, (i + 1) % n);
      twice += at.vertex(a, 0) * at.vertex(b, 1) - at.vertex(a, 1) * at.vertex(b, 0);
      for (int d = 0; d < 2; ++d) mean[d] += at.vertex(a, d) / n;
      for (int j = 0; j < n; ++j) {
        const LocalIndex c = at.cell_vertices(K, j);
        largest = std::max(largest, std::hypot(at.vertex(a, 0) - at.vertex(c, 0), at.vertex(a, 1) - at.vertex(c, 1)));
      }
    }
    EXPECT_NEAR(largest, at.diameter(K), 1e-13);
    for (int d = 0; d < 2; ++d) EXPECT_NEAR(mean[d], at.barycentre(K, d), 1e-14);
    if (grid.dimension == 1) {
      EXPECT_NEAR(at.vertex(at.cell_vertices(K, 1), 0) - at.vertex(at.cell_vertices(K, 0), 0), at.volume(K), 1e-14);
    } else {
      EXPECT_NEAR(twice / 2, at.volume(K), 1e-13);
    }
  }
}

TEST_P(Geometry, parts_of_the_boundary_lie_where_their_names_say) {
  double lower[2] = {INFINITY, INFINITY}, upper[2] = {-INFINITY, -INFINITY};
  for (LocalIndex v = 0; v < grid.vertices; ++v)
    for (int d = 0; d < 2; ++d) lower[d] = std::min(lower[d], at.vertex(v, d)), upper[d] = std::max(upper[d], at.vertex(v, d));
  for (int d = 0; d < 2; ++d) lower[d] = comm.min(lower[d]), upper[d] = comm.max(upper[d]);
  std::vector<int> found(grid.tags.size(), 0);
  const bool slanted = grid.corners() == 3;
  for (LocalIndex F = 0; F < grid.faces; ++F) {
    const LocalIndex tag = at.face_tag(F);
    if (tag < 0) continue;
    ++found[tag];
    const std::string& name = grid.tags[tag];
    const int d = name == "left" || name == "right" ? 0 : 1;
    const bool at_end = name == "right" || name == "top";
    EXPECT_GT((at_end ? 1 : -1) * at.face_normal(F, d), slanted ? 0.5 : 1 - 1e-15) << name;
    if (slanted && d == 0) continue;
    EXPECT_EQ(at.face_centre(F, d), at_end ? upper[d] : lower[d]) << name;
  }
  comm.sum(found);
  ASSERT_EQ(grid.tags.size(), grid.dimension == 1 ? 2u : 4u);
  for (const int count : found) EXPECT_GT(count, 0);
}

INSTANTIATE_TEST_SUITE_P(grids, Geometry, ::testing::ValuesIn(samples()), title);

}  // namespace thixis::fv
