#include "grids.hpp"
#include "output/scratch.hpp"
#include "output/written.hpp"

namespace thixis::fv {

TEST(display, shows_every_cell_once_in_the_order_of_ids) {
  const core::Comm comm;
  int number = 0;
  for (const Sample& sample : samples()) {
    const Grid grid = sample.make(comm), all = whole(sample);
    const HostGrid at = on_host(grid), at_all = on_host(all);
    const std::string folder = output::scratch("fv_" + std::to_string(number++));
    output::FieldData id{"id", output::Centre::cell, {}}, x{"x", output::Centre::vertex, {}};
    for (LocalIndex K = 0; K < grid.owned_cells; ++K) id.values.push_back(static_cast<double>(grid.cell_id[K]));
    for (LocalIndex v = 0; v < grid.vertices; ++v) x.values.push_back(at.vertex(v, 0));
    output::FieldWriter writer(folder, comm);
    writer.write(display(grid), {id, x}, 0);
    writer.write(display(grid), {id}, 1);
    writer.close();

    const auto document = output::read_xdmf(folder);
    const int corners = grid.corners();
    const char* kind = corners == 2 ? "Polyline" : corners == 3 ? "Triangle" : "Quadrilateral";
    for (const auto& found : document.select_nodes("//Topology"))
      EXPECT_EQ(found.node().attribute("TopologyType").as_string(), std::string(kind)) << sample.name;
    const std::string cells = corners == 2 ? "segments" : corners == 3 ? "triangles" : "quadrilaterals";
    const auto written = output::read_array(folder + "/fields.h5", "/mesh_0/" + cells);
    ASSERT_EQ(written.shape, (std::vector<long long>{grid.global_cells, corners})) << sample.name;
    for (GlobalIndex K = 0; K < grid.global_cells; ++K)
      for (int i = 0; i < corners; ++i) EXPECT_EQ(written.values[K * corners + i], at_all.cell_vertices(K, i));
    const auto ids = output::read_array(folder + "/fields.h5", "/fields_1/id");
    const auto points = output::read_array(folder + "/fields.h5", "/mesh_0/points"),
               xs = output::read_array(folder + "/fields.h5", "/fields_0/x");
    for (GlobalIndex K = 0; K < grid.global_cells; ++K) EXPECT_EQ(ids.values[K], K);
    for (GlobalIndex v = 0; v < grid.global_vertices; ++v) {
      EXPECT_EQ(xs.values[v], points.values[2 * v]);
      for (int d = 0; d < 2; ++d) EXPECT_EQ(points.values[2 * v + d], at_all.vertex(v, d));
    }
    EXPECT_TRUE(output::read_array(folder + "/fields.h5", "/mesh_1/points").shape.empty());  // the mesh is written once
    comm.barrier();
  }
}

}  // namespace thixis::fv
