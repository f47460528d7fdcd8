#include "thixis/mesh/ancestry.hpp"

#include <gtest/gtest.h>

#include "lineage.hpp"
#include "meshes.hpp"

namespace thixis::mesh {

TEST(child_shapes, hold_the_corners_of_every_child_counter_clockwise) {
  ASSERT_EQ(child_shapes().size(), 23u);
  for (std::size_t s = 0; s < child_shapes().size(); ++s) {
    const Corners& corner = child_shapes()[s];
    const double area =
        (corner[1][1] - corner[0][1]) * (corner[2][2] - corner[0][2]) - (corner[2][1] - corner[0][1]) * (corner[1][2] - corner[0][2]);
    EXPECT_EQ(area, s == 0 ? 1 : s >= 5 && (s - 5) % 6 < 2 ? 0.5 : 0.25);
    for (const auto& lambda : corner) EXPECT_EQ(lambda[0] + lambda[1] + lambda[2], 1);
  }
}

TEST(ancestry, of_uniform_levels_sums_the_areas_of_children_up_to_those_of_the_root) {
  for (const int cells_per_rank : {1, 60, 500, 1000000})
    for (const Hierarchy& hierarchy : {criss_cross(2, 3, core::Comm(), cells_per_rank), rectangle(1, 3, core::Comm(), cells_per_rank),
                                       disk(1, 3, core::Comm(), cells_per_rank)})
      for (int level = 0; level < static_cast<int>(hierarchy.levels.size()); ++level) expect_lineage(hierarchy, level);
}

TEST(ancestry, on_one_rank_lists_cells_by_their_ids) {
  const Hierarchy hierarchy = disk(2, 2, core::Comm(MPI_COMM_SELF));
  const Ancestry lineage = ancestry(hierarchy, 2);
  EXPECT_EQ(lineage.shared, 0);
  EXPECT_EQ(lineage.root->cells, hierarchy.levels[0].cells);
  EXPECT_EQ(lineage.root->coordinates.data(), hierarchy.levels[0].coordinates.data());
  for (int j = 1; j <= 2; ++j) {
    EXPECT_EQ(lineage.levels[j - 1].parent, hierarchy.levels[j].cell_parent);
    EXPECT_EQ(lineage.levels[j - 1].shape, hierarchy.levels[j].cell_shape);
  }
  for (LocalIndex K = 0; K < hierarchy.finest().cells; ++K) EXPECT_EQ(lineage.leaf[K], K);
}

}  // namespace thixis::mesh
