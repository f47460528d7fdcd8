#include "thixis/output/fields.hpp"

#include <gtest/gtest.h>

#include "scratch.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/host.hpp"
#include "written.hpp"

namespace thixis::output {
namespace {

const core::ExitCode internal = core::ExitCode::internal, input_output = core::ExitCode::input_output;

/// One triangle, on the last rank; the others hold nothing.
Grid single_triangle(const core::Comm& comm) {
  Grid grid;
  grid.global_points = 3;
  grid.global_triangles = 1;
  if (comm.rank() < comm.size() - 1) return grid;
  const int rank = comm.rank();
  grid.points = {{0, 0}, {1, 0}, {0, 1}};
  grid.point_id = {2, 0, 1};
  grid.point_owner = {rank, rank, rank};
  grid.triangles = {{0, 1, 2}};
  grid.triangle_id = {0};
  grid.triangle_owner = {rank};
  return grid;
}

/// The unit square cut into four: cell k belongs to rank k mod size, which also holds the others as ghosts.
mesh::Mesh cut_square(const core::Comm& comm) {
  mesh::Mesh mesh;
  mesh.comm = comm;
  mesh.global_cells = mesh.cells = 4;
  mesh.global_vertices = mesh.vertices = 5;
  const mesh::HostMesh host = mesh::allocate(mesh);
  const double corners[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}};
  for (int a = 0; a < 5; ++a) {
    for (int d = 0; d < 2; ++d) host.coordinates(a, d) = corners[a][d];
    mesh.vertex_id[a] = a;
    mesh.vertex_owner[a] = a % 4 % comm.size();
  }
  LocalIndex next = 0;
  for (const bool owned : {true, false})
    for (int k = 0; k < 4; ++k) {
      if ((k % comm.size() == comm.rank()) != owned) continue;
      host.cell_vertices(next, 0) = k;
      host.cell_vertices(next, 1) = (k + 1) % 4;
      host.cell_vertices(next, 2) = 4;
      mesh.cell_id[next] = k;
      mesh.cell_owner[next++] = k % comm.size();
      if (owned) mesh.owned_cells = next;
    }
  mesh::commit(host, mesh);
  return mesh;
}

}  // namespace

TEST(fields, stand_in_the_order_of_global_ids_and_ghosts_are_not_read) {
  const core::Comm comm;
  const std::string folder = scratch("ids"), path = folder + "/fields.h5";
  const Strip strip{20};
  const Grid grid = strip.grid(comm);
  FieldWriter writer(folder, comm);
  writer.write(grid,
               {owned_field("a", Centre::vertex, grid, comm, 1, [](GlobalIndex id, int) { return id + 0.25; }),
                owned_field("b", Centre::cell, grid, comm, 2, [](GlobalIndex id, int c) { return 10.0 * id + c; }),
                owned_field("c", Centre::vertex, grid, comm, 3, [](GlobalIndex id, int c) { return -10.0 * id - c; })},
               0);
  writer.close();
  const Array a = read_array(path, "/fields_0/a"), b = read_array(path, "/fields_0/b"), c = read_array(path, "/fields_0/c");
  const Array points = read_array(path, "/mesh_0/points"), triangles = read_array(path, "/mesh_0/triangles");
  ASSERT_EQ(a.shape, (std::vector<long long>{42}));
  ASSERT_EQ(b.shape, (std::vector<long long>{40, 3}));
  ASSERT_EQ(c.shape, (std::vector<long long>{42, 3}));
  ASSERT_EQ(points.shape, (std::vector<long long>{42, 2}));
  ASSERT_EQ(triangles.shape, (std::vector<long long>{40, 3}));
  for (int i = 0; i < 42; ++i) EXPECT_EQ(a.values[i], i + 0.25);
  for (int i = 0; i < 40; ++i)
    for (int d = 0; d < 3; ++d) EXPECT_EQ(b.values[3 * i + d], d < 2 ? 10 * i + d : 0);
  for (int i = 0; i < 126; ++i) EXPECT_EQ(c.values[i], -10.0 * (i / 3) - i % 3);
  for (int k = 0; k < 42; ++k)
    for (int d = 0; d < 2; ++d) EXPECT_EQ(points.values[2 * strip.point_number(k) + d], strip.point(k)[d]);
  for (int k = 0; k < 40; ++k)
    for (int i = 0; i < 3; ++i) EXPECT_EQ(triangles.values[3 * strip.triangle_number(k) + i], strip.point_number(strip.triangle(k)[i]));
}

TEST(fields, of_a_single_grid_make_a_plain_file_that_names_every_field) {
  const core::Comm comm;
  const std::string folder = scratch("plain");
  const Grid grid = Strip{3}.grid(comm);
  const auto value = [](GlobalIndex id, int) { return 1.0 * id; };
  FieldWriter(folder, comm)
      .write(grid, {owned_field("u", Centre::vertex, grid, comm, 1, value), owned_field("contact set", Centre::cell, grid, comm, 2, value)},
             4);
  const pugi::xml_document document = read_xdmf(folder);
  const pugi::xml_node element = document.select_node("/Xdmf[@Version='3.0']/Domain/Grid[@GridType='Uniform']").node();
  ASSERT_TRUE(element);
  EXPECT_TRUE(element.select_node("Attribute[@Name='u'][@Center='Node'][@AttributeType='Scalar']/DataItem[@Dimensions='8']"));
  EXPECT_TRUE(element.select_node("Attribute[@Name='contact set'][@Center='Cell'][@AttributeType='Vector']/DataItem[@Dimensions='6 3']"));
  EXPECT_FALSE(document.select_node("//Time"));
}

TEST(fields, are_written_by_ranks_that_own_nothing) {
  const core::Comm comm;
  const std::string folder = scratch("empty_ranks"), path = folder + "/fields.h5";
  const Grid grid = single_triangle(comm);
  FieldWriter(folder, comm).write(grid, {owned_field("u", Centre::cell, grid, comm, 1, [](GlobalIndex, int) { return 7.0; })}, 0);
  EXPECT_EQ(read_array(path, "/mesh_0/triangles").values, (std::vector<double>{2, 0, 1}));
  EXPECT_EQ(read_array(path, "/mesh_0/points").values, (std::vector<double>{1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(read_array(path, "/fields_0/u").values, (std::vector<double>{7}));
}

TEST(fields, of_a_mesh_may_end_after_the_owned_cells) {
  const core::Comm comm;
  const std::string folder = scratch("mesh"), path = folder + "/fields.h5";
  const mesh::Mesh mesh = cut_square(comm);
  FieldData k{"k", Centre::cell, {}}, a{"a", Centre::vertex, {0, 1, 2, 3, 4}};
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) k.values.push_back(static_cast<double>(mesh.cell_id[K]));
  FieldWriter(folder, comm).write(mesh, {k, a}, 0);
  EXPECT_EQ(read_array(path, "/fields_0/k").values, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(read_array(path, "/fields_0/a").values, (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(read_array(path, "/mesh_0/triangles").values, (std::vector<double>{0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}));
  EXPECT_EQ(read_array(path, "/mesh_0/points").values, (std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5}));
}

TEST(fields, that_contradict_the_grid_or_themselves_are_refused_on_all_ranks) {
  const core::Comm comm;
  const std::string folder = scratch("wrong");
  const Grid grid = Strip{3}.grid(comm);
  const bool spoiler = comm.root();
  FieldWriter writer(folder, comm);
  const auto sentence = [&](const std::vector<FieldData>& fields) { return sentence_of(internal, [&] { writer.write(grid, fields, 0); }); };
  const std::vector<double> eight(8), six(6);
  EXPECT_EQ(sentence({{"u", Centre::vertex, spoiler ? std::vector<double>{} : eight}}).substr(0, 32), "The field 'u' has 0 values where");
  EXPECT_EQ(sentence({{"u", Centre::vertex, eight, 4}}), "The field 'u' has 4 components; it must have 1, 2 or 3.");
  EXPECT_EQ(sentence({{"u", Centre::vertex, eight}, {"u", Centre::cell, six}}), "Two fields are called 'u'.");
  for (const char* name : {"", "a/b", "u:1", " u", "<u>", ".", "\xc3\xa9ta"})
    EXPECT_EQ(sentence({{name, Centre::cell, six}}), "A field can not be called '" + std::string(name) +
                                                         "': its name must be made of letters, digits, '_', '-', '.' and inner spaces.");
  if (comm.size() > 1) {
    EXPECT_EQ(sentence({{spoiler ? "u" : "v", Centre::cell, six}}), "All ranks must write the same fields in the same order.");
  }
  Grid spoilt = grid;
  if (spoiler) spoilt.point_id.pop_back();
  EXPECT_EQ(sentence_of(internal, [&] { writer.write(spoilt, {}, 0); }),
            "A grid must have as many numbers and owners as points and triangles.");
  spoilt = grid;
  for (int& owner : spoilt.point_owner) owner = comm.size();
  EXPECT_EQ(sentence_of(internal, [&] { writer.write(spoilt, {}, 0); }), "8 of 8 points have no owner.");
  writer.write(grid, {{"u", Centre::vertex, eight}}, 0);
  EXPECT_EQ(read_array(folder + "/fields.h5", "/fields_0/u").shape, (std::vector<long long>{8}));
}

TEST(fields, in_an_impossible_place_are_refused_on_all_ranks_in_one_sentence) {
  const core::Comm comm;
  const std::string folder = scratch("places");
  if (comm.root()) std::ofstream(folder + "/file") << "x";
  if (comm.root()) std::filesystem::create_directories(folder + "/taken/fields.h5");
  comm.barrier();
  ::testing::internal::CaptureStderr();
  const auto sentence = [&](const std::string& place) { return sentence_of(input_output, [&] { FieldWriter(place, comm); }); };
  EXPECT_EQ(sentence(folder + "/none"), "The file '" + folder + "/none/fields.h5' can not be created: No such file or directory.");
  EXPECT_EQ(sentence(folder + "/file"), "The file '" + folder + "/file/fields.h5' can not be created: Not a directory.");
  const std::string taken = "The file '" + folder + "/taken/fields.h5' can not be written: there is a folder of this name, and ";
  EXPECT_EQ(sentence(folder + "/taken").substr(0, taken.size()), taken);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(fields, on_a_full_disk_are_an_error_on_all_ranks_and_earlier_ones_stay_readable) {
  const core::Comm comm;
  const std::string folder = scratch("full_disk");
  const auto one = [](GlobalIndex, int) { return 1.0; };
  const Grid small = Strip{3}.grid(comm), large = Strip{20000}.grid(comm);
  FieldWriter writer(folder, comm);
  writer.write(small, {owned_field("u", Centre::vertex, small, comm, 1, one)}, 0);
  const std::string before = content(folder + "/fields.xdmf");
  comm.barrier();
  ::testing::internal::CaptureStderr();
  {
    const FullDisk full(100000);
    EXPECT_EQ(sentence_of(input_output, [&] { writer.write(large, {owned_field("u", Centre::vertex, large, comm, 1, one)}, 1); }),
              "The file '" + folder + "/fields.h5' can not grow by 1.95 MB: File too large.");
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(content(folder + "/fields.xdmf"), before);
  read_xdmf(folder);
  comm.barrier();
  writer.write(small, {owned_field("u", Centre::vertex, small, comm, 1, one)}, 2);
  EXPECT_EQ(read_array(folder + "/fields.h5", "/fields_1/u").values, std::vector<double>(8, 1.0));
}

TEST(fields, reserve_more_than_they_need_and_give_the_rest_back) {
  const core::Comm comm;
  const std::string folder = scratch("room"), path = folder + "/fields.h5";
  const Grid grid = Strip{1000}.grid(comm);
  FieldWriter writer(folder, comm);
  std::vector<FieldData> fields;
  for (int k = 0; k < 40; ++k)
    fields.push_back(
        owned_field("a field with a long name " + std::to_string(k), Centre::cell, grid, comm, 1, [](GlobalIndex, int) { return 1.0; }));
  auto before = static_cast<long long>(std::filesystem::file_size(path));
  const long long mesh = 8 * (2 * 2002 + 3 * 2000), data = 40 * 8 * 2000;
  for (int n = 0; n < 70; ++n) {
    writer.write(grid, fields, n);
    const auto after = static_cast<long long>(std::filesystem::file_size(path)), needed = data + (n == 0 ? mesh : 0);
    EXPECT_GE(after - before, needed);
    EXPECT_LT(after - before, needed + 8192 * (n == 0 ? 2 : 1) + 4096 * (n == 0 ? 42 : 40)) << n;
    before = after;
    comm.barrier();
  }
}

TEST(fields, of_a_refined_disk_are_left_for_other_readers) {
  const core::Comm comm;
  scratch("for_meshio/single");
  mesh::MeshParams params;
  params.generator = mesh::Generator::disk;
  params.refinements = 1;
  params.cells_per_rank = 10;
  const mesh::Hierarchy hierarchy = mesh::build(params, comm, ".");
  const mesh::Mesh& mesh = hierarchy.finest();
  const mesh::HostMesh host = mesh::on_host(mesh);
  const auto x = [&](LocalIndex a, int d) { return host.coordinates(a, d); };
  FieldData u{"u", Centre::vertex, {}}, gradient{"gradient", Centre::vertex, {}, 2}, area{"area", Centre::cell, {}},
      tx{"u", Centre::vertex, {}};
  for (LocalIndex a = 0; a < mesh.vertices; ++a) {
    u.values.push_back(x(a, 0) * x(a, 0) + 2 * x(a, 1));
    gradient.values.insert(gradient.values.end(), {2 * x(a, 0), 2});
    tx.values.push_back(0);
  }
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    const LocalIndex p = host.cell_vertices(K, 0), q = host.cell_vertices(K, 1), r = host.cell_vertices(K, 2);
    area.values.push_back(((x(q, 0) - x(p, 0)) * (x(r, 1) - x(p, 1)) - (x(q, 1) - x(p, 1)) * (x(r, 0) - x(p, 0))) / 2);
  }
  FieldWriter(scratch("for_meshio/single"), comm).write(mesh, {u, gradient, area}, 0);
  FieldWriter series(scratch("for_meshio/series"), comm);
  series.write(mesh, {tx}, 0);
  for (LocalIndex a = 0; a < mesh.vertices; ++a) tx.values[a] = 0.5 * x(a, 0);
  series.write(mesh, {tx}, 0.5);
  series.close();
  read_xdmf((scratch_folder(comm.size()) / "for_meshio/single").string());
}

TEST(fields, can_be_written_on_every_level_of_a_hierarchy) {
  const core::Comm comm;
  const std::string folder = scratch("levels");
  mesh::MeshParams params;
  params.cells_per_side = 2;
  params.refinements = 3;
  params.cells_per_rank = 50;
  const mesh::Hierarchy hierarchy = mesh::build(params, comm, ".");
  FieldWriter writer(folder, comm);
  for (std::size_t level = 0; level < hierarchy.levels.size(); ++level) {
    const mesh::Mesh& mesh = hierarchy.levels[level];
    FieldData id{"id", Centre::cell, {}};
    for (LocalIndex K = 0; K < mesh.cells; ++K) id.values.push_back(static_cast<double>(mesh.cell_id[K]));
    writer.write(mesh, {id}, static_cast<double>(level));
    const Array written = read_array(folder + "/fields.h5", "/fields_" + std::to_string(level) + "/id");
    ASSERT_EQ(written.shape, (std::vector<long long>{mesh.global_cells}));
    for (GlobalIndex i = 0; i < mesh.global_cells; ++i) EXPECT_EQ(written.values[i], i);
    comm.barrier();
  }
  read_xdmf(folder);
}

}  // namespace thixis::output
