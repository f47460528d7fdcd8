#include <gtest/gtest.h>

#include "scratch.hpp"
#include "thixis/output/fields.hpp"
#include "written.hpp"

namespace thixis::output {
namespace {

FieldData constant(const Grid& grid, const core::Comm& comm, double value) {
  return owned_field("u", Centre::vertex, grid, comm, 1, [&](GlobalIndex, int) { return value; });
}

std::vector<double> times(const pugi::xml_document& document) {
  std::vector<double> result;
  for (const auto& time : document.select_nodes("/Xdmf/Domain/Grid[@CollectionType='Temporal']/Grid/Time"))
    result.push_back(time.node().attribute("Value").as_double());
  return result;
}

std::string triangles_of(const pugi::xml_document& document, int grid) {
  return document.select_node(("//Grid[@Name='grid " + std::to_string(grid) + "']/Topology/DataItem").c_str()).node().text().as_string();
}

}  // namespace

TEST(series, can_be_read_after_every_write) {
  const core::Comm comm;
  const std::string folder = scratch("growing");
  const Grid grid = Strip{4}.grid(comm);
  FieldWriter writer(folder, comm);
  EXPECT_FALSE(std::filesystem::exists(folder + "/fields.xdmf"));
  std::vector<double> expected;
  for (int n = 0; n < 4; ++n) {
    expected.push_back(n / 3.0);
    writer.write(grid, {constant(grid, comm, n)}, n / 3.0);
    const pugi::xml_document document = read_xdmf(folder);
    EXPECT_EQ(times(document), n > 0 ? expected : std::vector<double>{});
    EXPECT_EQ(read_array(folder + "/fields.h5", "/fields_" + std::to_string(n) + "/u").values, std::vector<double>(10, n));
    comm.barrier();
  }
}

TEST(series, shares_the_mesh_as_long_as_it_stays_the_same) {
  const core::Comm comm;
  const std::string folder = scratch("shared"), path = folder + "/fields.h5";
  Grid grid = Strip{4}.grid(comm);
  FieldWriter writer(folder, comm);
  writer.write(grid, {constant(grid, comm, 1)}, 0);
  const Grid copy = grid;
  writer.write(copy, {constant(copy, comm, 2)}, 1);
  for (std::size_t i = 0; i < grid.points.size(); ++i)
    if (grid.point_id[i] == 5) grid.points[i][0] += 0.125;
  writer.write(grid, {constant(grid, comm, 3)}, 2);
  const Grid longer = Strip{5}.grid(comm);
  writer.write(longer, {constant(longer, comm, 4)}, 3);
  Grid turned = longer;
  for (std::size_t i = 0; i < turned.triangles.size(); ++i)
    if (turned.triangle_id[i] == 2) std::swap(turned.triangles[i][0], turned.triangles[i][1]);
  writer.write(turned, {constant(turned, comm, 5)}, 4);
  writer.close();
  const pugi::xml_document document = read_xdmf(folder);
  const int mesh_of[] = {0, 0, 2, 3, 4};
  for (int n = 0; n < 5; ++n) EXPECT_EQ(triangles_of(document, n), "fields.h5:/mesh_" + std::to_string(mesh_of[n]) + "/triangles");
  EXPECT_TRUE(read_array(path, "/mesh_1/points").shape.empty());
  EXPECT_EQ(read_array(path, "/mesh_2/points").values[10], read_array(path, "/mesh_0/points").values[10] + 0.125);
}

TEST(series, goes_forward_in_time_and_ends_with_close) {
  const core::Comm comm;
  const std::string folder = scratch("order");
  const Grid grid = Strip{4}.grid(comm);
  FieldWriter writer(folder, comm);
  writer.write(grid, {}, 1);
  for (const double time : {1.0, 0.5, std::nan(""), HUGE_VAL}) {
    const std::string sentence = sentence_of(core::ExitCode::internal, [&] { writer.write(grid, {}, time); });
    EXPECT_EQ(sentence.substr(0, 45), "Fields must be written in the order of time; ");
  }
  writer.write(grid, {}, 2);
  writer.close();
  writer.close();
  EXPECT_EQ(sentence_of(core::ExitCode::internal, [&] { writer.write(grid, {}, 3); }),
            "'" + folder + "/fields.h5' is closed, nothing can be written to it.");
  EXPECT_EQ(times(read_xdmf(folder)), (std::vector<double>{1, 2}));
}

TEST(series, of_many_grids_is_listed_whole_in_the_end) {
  const core::Comm comm;
  const Grid grid = Strip{1}.grid(comm);
  for (const bool closed : {true, false}) {
    const std::string folder = scratch("long");
    {
      FieldWriter writer(folder, comm);
      for (int n = 0; n < 131; ++n) writer.write(grid, {}, n);
      comm.barrier();
      EXPECT_EQ(times(read_xdmf(folder)).size(), 130u);
      comm.barrier();
      if (closed) writer.close();
    }
    comm.barrier();
    EXPECT_EQ(times(read_xdmf(folder)).size(), 131u);
    comm.barrier();
  }
}

TEST(series, replaces_an_older_one) {
  const core::Comm comm;
  const std::string folder = scratch("replaced");
  const Grid grid = Strip{4}.grid(comm);
  {
    FieldWriter writer(folder, comm);
    writer.write(grid, {constant(grid, comm, 1)}, 0);
    writer.write(grid, {constant(grid, comm, 1)}, 1);
  }
  comm.barrier();
  FieldWriter writer(folder, comm);
  EXPECT_FALSE(std::filesystem::exists(folder + "/fields.xdmf"));
  comm.barrier();
  writer.write(grid, {}, 0);
  EXPECT_TRUE(times(read_xdmf(folder)).empty());
  EXPECT_TRUE(read_array(folder + "/fields.h5", "/fields_1/u").shape.empty());
}

}  // namespace thixis::output
