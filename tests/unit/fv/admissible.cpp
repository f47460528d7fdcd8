#include "grids.hpp"

namespace thixis::fv {

TEST(triangles, that_share_their_longest_side_at_right_angles_are_refused) {
  const core::Comm comm;
  mesh::MeshParams params;
  params.cells_per_side = 2;
  params.generator = mesh::Generator::rectangle;
  // the 4 diagonals; the right angles lie on the boundary, where the circumcentres are half a side away from it
  EXPECT_EQ(
      refusal(params),
      "mesh/generator: two-point fluxes do not admit this mesh: at 4 of 16 faces, the first one at (0.25, 0.25), the circumcentres of "
      "the triangles do not lie apart and in the order of the triangles, or not inside of the boundary; write mesh/generator = "
      "tensor, or give a Gmsh mesh of acute triangles.");
  params.generator = mesh::Generator::criss_cross;
  for (const int refinements : {0, 1, 2}) {
    params.refinements = refinements;
    EXPECT_EQ(refusal(params).rfind("mesh/generator: two-point fluxes do not admit this mesh: at ", 0), 0u) << refusal(params);
  }
}

TEST(triangles, obtuse_at_the_boundary_are_refused) {
  const core::Comm comm;
  const std::string folder = parallelogram(3, 0.5, 0.4, comm);
  // 3 bases each on the lower and the upper side, and those of the 2 rows between, where the circumcentres have changed their order
  const std::string sentence = refusal(file_params(0), folder);
  EXPECT_EQ(sentence.rfind("mesh/file: two-point fluxes do not admit this mesh: at 12 of 33 faces, the first one at (", 0), 0u) << sentence;
}

TEST(triangles, acute_ones_are_admitted_and_have_circumcentres) {
  const core::Comm comm;
  const Grid grid = acute_grid(2, comm);
  const HostGrid at = on_host(grid);
  for (LocalIndex K = 0; K < grid.cells; ++K) {
    double radius[3];
    for (int i = 0; i < 3; ++i) {
      const LocalIndex a = at.cell_vertices(K, i);
      radius[i] = std::hypot(at.vertex(a, 0) - at.centre(K, 0), at.vertex(a, 1) - at.centre(K, 1));
    }
    EXPECT_NEAR(radius[1], radius[0], 1e-14);
    EXPECT_NEAR(radius[2], radius[0], 1e-14);
  }
}

TEST(triangles, of_the_disk_are_admitted) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::disk;
  for (params.rings = 1; params.rings < 6; ++params.rings)
    for (params.refinements = 0; params.refinements < 3; ++params.refinements)
      EXPECT_EQ(refusal(params), "") << params.rings << " rings, refined " << params.refinements << " times";
}

}  // namespace thixis::fv
