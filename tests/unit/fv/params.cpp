#include "grids.hpp"

namespace thixis::fv {

TEST(parameters, that_make_no_grid_are_refused_with_what_to_write) {
  mesh::MeshParams params = interval_params(10);
  params.cells = {};
  EXPECT_EQ(refusal(params), "mesh/cells: write the number of intervals, such as {100}.");
  params.cells = {4, 4};
  EXPECT_EQ(refusal(params), "mesh/cells: write the number of intervals, such as {100}.");
  params = tensor_params(4, 0);
  EXPECT_EQ(refusal(params), "mesh/cells: write the numbers of rectangles along x and along y, such as {40, 20}.");
  params = tensor_params(4, 4, {0});
  EXPECT_EQ(refusal(params), "mesh/lower: write two coordinates, such as {0, 0}.");
  params = tensor_params(4, 4, {0, 0}, {1, -1});
  EXPECT_EQ(refusal(params), "mesh/upper: write finite coordinates, each larger than that of 'lower'.");
  params = interval_params(4, 2, 1);
  EXPECT_EQ(refusal(params), "mesh/upper: write a finite coordinate larger than that of 'lower'.");
  params.lower = {0, 3};
  EXPECT_EQ(refusal(params), "mesh/lower: an interval begins at one coordinate; write it, such as {0}.");
}

TEST(parameters, of_grids_too_large_to_hold_are_refused) {
  mesh::MeshParams params = tensor_params(100000, 100000);
  const std::string sentence =
      "mesh/cells: a rank would hold more than 500 million cells; write fewer cells or refinements, or use more ranks.";
  EXPECT_EQ(refusal(params), sentence);
  params = tensor_params(4, 4);
  params.refinements = 200;
  EXPECT_EQ(refusal(params), sentence);
}

TEST(interval, may_leave_out_its_ends) {
  mesh::MeshParams params = interval_params(4);
  params.lower = {0, 0};
  params.upper = {1, 1};
  params.refinements = 2;
  const Grid grid = fv::build(params, core::Comm(), ".");
  EXPECT_EQ(grid.global_cells, 16);
  const HostGrid at = on_host(grid);
  for (LocalIndex K = 0; K < grid.cells; ++K) EXPECT_EQ(at.volume(K), 1.0 / 16);
}

}  // namespace thixis::fv
