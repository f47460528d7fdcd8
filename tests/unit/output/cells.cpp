#include <gtest/gtest.h>

#include "scratch.hpp"
#include "thixis/output/fields.hpp"
#include "written.hpp"

namespace thixis::output {
namespace {

const core::ExitCode internal = core::ExitCode::internal;

/// n segments on y = 0, or n squares above it, of size 1/2. All ranks hold everything; point k has the number (5 k + 2) mod their number,
/// cell k the number (3 k + 1) mod n, which asks for numbers of entities without the factors 5 and 3.
Grid row(int n, int corners, const core::Comm& comm) {
  Grid grid;
  const int layers = corners / 2;
  const int points = layers * (n + 1);
  grid.global_points = points;
  for (int k = 0; k < points; ++k) {
    grid.points.push_back({(k / layers) / 2.0, (k % layers) / 2.0});
    grid.point_id.push_back((5 * k + 2) % points);
    grid.point_owner.push_back(k % comm.size());
  }
  Cells& cells = grid.others;
  cells.corners = corners;
  cells.global = n;
  for (int k = 0; k < n; ++k) {
    const std::vector<LocalIndex> of_cell =
        corners == 2 ? std::vector<LocalIndex>{k, k + 1} : std::vector<LocalIndex>{2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1};
    cells.points.insert(cells.points.end(), of_cell.begin(), of_cell.end());
    cells.id.push_back((3 * k + 1) % n);
    cells.owner.push_back((k / 2) % comm.size());
  }
  return grid;
}

/// Coordinates of the centres, NaN for cells of others.
FieldData centres(const Grid& grid, const core::Comm& comm) {
  FieldData field{"centre", Centre::cell, {}, 2};
  const Cells& cells = grid.others;
  for (std::size_t K = 0; K < grid.cells(); ++K)
    for (int d = 0; d < 2; ++d) {
      double sum = 0;
      for (int i = 0; i < cells.corners; ++i) sum += grid.points[cells.points[K * cells.corners + i]][d];
      field.values.push_back(cells.owner[K] == comm.rank() ? sum / cells.corners : NAN);
    }
  return field;
}

FieldData abscissae(const Grid& grid, double factor) {
  FieldData field{"x", Centre::vertex, {}};
  for (const auto& point : grid.points) field.values.push_back(factor * point[0]);
  return field;
}

}  // namespace

TEST(cells, segments_and_quadrilaterals_stand_in_the_order_of_their_numbers) {
  const core::Comm comm;
  for (const int corners : {2, 4}) {
    const std::string name = corners == 2 ? "segments" : "quadrilaterals", folder = scratch("for_meshio/" + name);
    const Grid grid = row(7, corners, comm);
    FieldWriter(folder, comm).write(grid, {centres(grid, comm), abscissae(grid, 1)}, 0);
    const auto cells = read_array(folder + "/fields.h5", "/mesh_0/" + name), centre = read_array(folder + "/fields.h5", "/fields_0/centre");
    ASSERT_EQ(cells.shape, (std::vector<long long>{7, corners}));
    for (int k = 0; k < 7; ++k) {
      const GlobalIndex id = grid.others.id[k];
      for (int i = 0; i < corners; ++i) EXPECT_EQ(cells.values[id * corners + i], grid.point_id[grid.others.points[k * corners + i]]);
      EXPECT_EQ(centre.values[3 * id], k / 2.0 + 0.25);
      EXPECT_EQ(centre.values[3 * id + 1], corners == 2 ? 0 : 0.25);
    }
    EXPECT_TRUE(read_array(folder + "/fields.h5", "/mesh_0/triangles").shape.empty());
    const auto document = read_xdmf(folder);
    EXPECT_STREQ(document.select_node("//Topology").node().attribute("TopologyType").as_string(),
                 corners == 2 ? "Polyline" : "Quadrilateral");
    comm.barrier();
  }
}

TEST(cells, segments_make_series_in_time) {
  const core::Comm comm;
  const std::string folder = scratch("for_meshio/segments_in_time");
  const Grid grid = row(7, 2, comm);
  FieldWriter writer = FieldWriter::series(folder, comm);
  for (int n = 0; n < 3; ++n) writer.write(grid, {abscissae(grid, n), centres(grid, comm)}, n / 4.0);
  writer.close();
  const auto document = read_xdmf(folder);
  for (const auto& found : document.select_nodes("//Topology"))
    EXPECT_STREQ(found.node().child("DataItem").text().as_string(), "fields/000000.h5:/mesh_0/segments");
}

TEST(cells, of_another_kind_make_another_mesh) {
  const core::Comm comm;
  const std::string folder = scratch("kinds");
  const Grid segments = row(7, 2, comm), squares = row(7, 4, comm), triangles = Strip{7}.grid(comm);
  FieldWriter writer(folder, comm);
  double time = 0;
  for (const Grid* grid : {&segments, &squares, &triangles, &triangles}) writer.write(*grid, {abscissae(*grid, 1)}, time++);
  const std::string path = folder + "/fields.h5";
  EXPECT_EQ(read_array(path, "/mesh_0/segments").shape, (std::vector<long long>{7, 2}));
  EXPECT_EQ(read_array(path, "/mesh_1/quadrilaterals").shape, (std::vector<long long>{7, 4}));
  EXPECT_EQ(read_array(path, "/mesh_2/triangles").shape, (std::vector<long long>{14, 3}));
  EXPECT_TRUE(read_array(path, "/mesh_3/points").shape.empty());
  read_xdmf(folder);
}

TEST(cells, that_contradict_each_other_are_refused_on_all_ranks) {
  const core::Comm comm;
  FieldWriter writer(scratch("contradictions"), comm);
  const auto sentence = [&](const Grid& grid) { return sentence_of(internal, [&] { writer.write(grid, {}, 0); }); };
  const Grid good = row(7, 4, comm);
  Grid grid = good;
  grid.triangles = {{0, 1, 2}};
  EXPECT_EQ(sentence(grid), "A grid must have cells of one kind, not triangles and others.");
  grid = good;
  grid.others.corners = 5;
  EXPECT_EQ(sentence(grid), "The cells of a grid must have 2, 3 or 4 corners, not 5.");
  grid = good;
  if (comm.root()) grid.others.points.pop_back();
  EXPECT_EQ(sentence(grid), "A grid must have as many numbers and owners as points and quadrilaterals.");
  grid = good;
  if (comm.root()) grid.others.points[3] = 16;
  EXPECT_EQ(sentence(grid), "A quadrilateral of a grid refers to the point 16 of 16.");
  grid = good;
  for (int& owner : grid.others.owner) owner = comm.size();
  EXPECT_EQ(sentence(grid), "7 of 7 quadrilaterals have no owner.");
  if (comm.size() > 1) {
    grid = comm.root() ? good : row(7, 2, comm);
    EXPECT_EQ(sentence(grid), "The cells of a grid must be of the same kind on all ranks.");
  }
  writer.write(good, {}, 0);
}

}  // namespace thixis::output
