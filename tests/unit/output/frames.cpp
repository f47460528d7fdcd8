#include <gtest/gtest.h>

#include <map>

#include "scratch.hpp"
#include "thixis/output/fields.hpp"
#include "written.hpp"

namespace thixis::output {
namespace {

namespace fs = std::filesystem;

const core::ExitCode internal = core::ExitCode::internal, input_output = core::ExitCode::input_output;

/// Frame n of a run in time whose mesh is refined behind frame 1: u = id + n on points, names not in the order of the alphabet.
void write_frame(FieldWriter& writer, int n, const core::Comm& comm) {
  const Grid grid = Strip{n < 2 ? 4 : 7}.grid(comm);
  const auto value = [n](GlobalIndex id, int c) { return static_cast<double>(id) + n + 0.25 * c; };
  writer.write(grid, {owned_field("u", Centre::vertex, grid, comm, 1, value), owned_field("flow", Centre::cell, grid, comm, 2, value)},
               n / 3.0);
}

/// The strip of four squares, or the segments below them, in place of its triangles; cell k has the number 3 - k.
Grid other_grid(int corners, const core::Comm& comm) {
  const Strip strip{4};
  Grid grid = strip.grid(comm);
  grid.global_triangles = 0;
  grid.triangles.clear();
  grid.triangle_id.clear();
  grid.triangle_owner.clear();
  grid.others.corners = corners;
  grid.others.global = strip.n;
  for (int k = 0; k < strip.n; ++k) {
    grid.others.id.push_back(strip.n - 1 - k);
    grid.others.owner.push_back(k % comm.size());
    const std::array<int, 4> square{2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1};
    for (int c = 0; c < corners; ++c) grid.others.points.push_back((square[c] - comm.rank() + strip.points()) % strip.points());
  }
  return grid;
}

/// A run of this many frames that kept some.
void run(const std::string& folder, int kept, int frames, const core::Comm& comm, bool closed = true) {
  FieldWriter writer = FieldWriter::series(folder, comm, kept);
  EXPECT_EQ(writer.frames(), kept);
  for (int n = kept; n < frames; ++n) write_frame(writer, n, comm);
  EXPECT_EQ(writer.frames(), frames);
  if (closed) writer.close();
}

std::string frame(const std::string& folder, int n) { return folder + "/fields/00000" + std::to_string(n) + ".h5"; }

/// The bytes of all files of a folder and the folders in it.
std::map<std::string, std::string> files(const std::string& folder) {
  const core::Comm comm;
  comm.barrier();
  std::map<std::string, std::string> result;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) result[fs::relative(entry.path(), folder).string()] = content(entry.path().string());
  comm.barrier();
  return result;
}

std::vector<std::string> names(const std::map<std::string, std::string>& files) {
  std::vector<std::string> result;
  for (const auto& file : files) result.push_back(file.first);
  return result;
}

void expect_same(const std::string& folder, const std::string& whole) {
  const auto a = files(folder), b = files(whole);
  EXPECT_EQ(names(a), names(b));
  for (const auto& [name, bytes] : b) EXPECT_TRUE(a.count(name) && a.at(name) == bytes) << name << " differs from that of " << whole;
}

std::vector<double> times(const std::string& folder) {
  std::vector<double> result;
  const pugi::xml_document document = read_xdmf(folder);
  for (const auto& time : document.select_nodes("/Xdmf/Domain/Grid[@CollectionType='Temporal']/Grid/Time"))
    result.push_back(time.node().attribute("Value").as_double());
  return result;
}

/// Leaves of the file what stands before this share of it.
void cut_off(const std::string& path, double share, const core::Comm& comm) {
  comm.on_root([&] { fs::resize_file(path, static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(path)))); });
}

}  // namespace

TEST(frames, have_files_of_their_own_that_fields_h5_and_the_xdmf_file_show) {
  const core::Comm comm;
  const std::string folder = scratch("frames"), path = folder + "/fields.h5";
  FieldWriter writer = FieldWriter::series(folder, comm);
  EXPECT_FALSE(fs::exists(folder + "/fields.xdmf"));
  EXPECT_EQ(names(files(folder)), std::vector<std::string>{"fields.h5"});
  std::vector<double> expected;
  for (int n = 0; n < 3; ++n) {
    write_frame(writer, n, comm);
    expected.push_back(n / 3.0);
    EXPECT_EQ(times(folder), expected) << "also between the calls";
    const int points = n < 2 ? 10 : 16;
    const Array u = read_array(path, "/fields_" + std::to_string(n) + "/u");
    ASSERT_EQ(u.shape, std::vector<long long>{points});
    for (int i = 0; i < points; ++i) EXPECT_EQ(u.values[i], i + n);
    EXPECT_EQ(read_array(path, "/fields_" + std::to_string(n) + "/flow").shape, (std::vector<long long>{points - 2, 3}));
    comm.barrier();
  }
  writer.close();
  EXPECT_EQ(names(files(folder)),
            (std::vector<std::string>{"fields.h5", "fields.xdmf", "fields/000000.h5", "fields/000001.h5", "fields/000002.h5"}));
  EXPECT_EQ(read_array(path, "/mesh_0/triangles").shape, (std::vector<long long>{8, 3}));
  EXPECT_TRUE(read_array(path, "/mesh_1/triangles").shape.empty()) << "the mesh of frame 0 serves for frame 1";
  EXPECT_EQ(read_array(path, "/mesh_2/points").shape, (std::vector<long long>{16, 2}));
  EXPECT_EQ(content(folder + "/fields.xdmf").find("fields.h5"), std::string::npos) << "readers need not follow links";
}

TEST(frames, are_the_same_bytes_when_an_interrupted_run_goes_on) {
  const core::Comm comm;
  const std::string whole = scratch("frames_whole");
  run(whole, 0, 4, comm);
  for (int written = 0; written <= 4; ++written)
    for (int kept = 0; kept <= written; ++kept) {
      const std::string folder = scratch("frames_cut");
      run(folder, 0, written, comm, false);
      comm.barrier();
      run(folder, kept, 4, comm);
      expect_same(folder, whole);
    }
}

TEST(frames, go_on_on_another_number_of_ranks) {
  const core::Comm comm;
  const std::string whole = scratch("frames_all_ranks"), folder = scratch("frames_other_ranks");
  run(whole, 0, 4, comm);
  MPI_Comm alone;
  MPI_Comm_split(comm.mpi(), comm.rank(), 0, &alone);
  if (comm.root()) run(folder, 0, 1, core::Comm(alone));
  comm.barrier();
  run(folder, 1, 3, comm);
  comm.barrier();
  if (comm.root()) run(folder, 3, 4, core::Comm(alone));
  comm.barrier();
  MPI_Comm_free(&alone);
  expect_same(folder, whole);
}

TEST(frames, that_are_written_again_may_be_damaged_and_those_that_stay_may_not) {
  const core::Comm comm;
  const std::string whole = scratch("frames_good"), folder = scratch("frames_damaged");
  run(whole, 0, 3, comm);
  for (const double share : {0.9, 0.5, 0.01, 0.0}) {
    run(folder, 0, 3, comm);
    comm.barrier();
    cut_off(frame(folder, 2), share, comm);
    const auto before = files(folder);
    EXPECT_EQ(sentence_of(input_output, [&] { FieldWriter::series(folder, comm, 3); }),
              "The fields can not go on in time: the file '" + frame(folder, 2) + "' is damaged; begin anew with 'thixis run'.");
    EXPECT_EQ(files(folder), before) << "nothing is changed";
    run(folder, 2, 3, comm);
    expect_same(folder, whole);
  }
  for (const std::size_t at : {0u, 40u, 511u, 512u, 700u, 3000u}) {
    const std::string bytes = content(frame(folder, 1));
    comm.barrier();
    comm.on_root([&] {
      std::string turned = bytes;
      turned[at] ^= 1;
      std::ofstream(frame(folder, 1), std::ios::binary) << turned;
    });
    EXPECT_EQ(sentence_of(input_output, [&] { FieldWriter::series(folder, comm, 3); }),
              "The fields can not go on in time: the file '" + frame(folder, 1) + "' is damaged; begin anew with 'thixis run'.")
        << "byte " << at;
    comm.on_root([&] { std::ofstream(frame(folder, 1), std::ios::binary) << bytes; });
  }
  EXPECT_EQ(sentence_of(input_output, [&] { FieldWriter::series(folder, comm, 4); }),
            "The fields can not go on in time: the file '" + frame(folder, 3) + "' is missing; begin anew with 'thixis run'.");
  comm.on_root([&] { fs::copy_file(frame(folder, 0), frame(folder, 1), fs::copy_options::overwrite_existing); });
  EXPECT_EQ(sentence_of(input_output, [&] { FieldWriter::series(folder, comm, 2); }),
            "The fields can not go on in time: the file '" + frame(folder, 1) + "' is damaged; begin anew with 'thixis run'.");
}

TEST(frames, replace_those_of_an_older_run_and_nothing_else) {
  const core::Comm comm;
  const std::string folder = scratch("frames_replaced"), fresh = scratch("frames_fresh");
  const Grid grid = Strip{4}.grid(comm);
  run(fresh, 0, 1, comm);
  FieldWriter(folder, comm).write(grid, {}, 0);
  comm.barrier();
  run(folder, 0, 3, comm, false);
  comm.barrier();
  comm.on_root([&] {
    std::ofstream(frame(folder, 7) + ".part") << "killed";
    std::ofstream(folder + "/fields/mine.h5") << "x";
    std::ofstream(folder + "/fields/000001.txt") << "x";
  });
  run(folder, 0, 1, comm);
  EXPECT_EQ(names(files(folder)),
            (std::vector<std::string>{"fields.h5", "fields.xdmf", "fields/000000.h5", "fields/000001.txt", "fields/mine.h5"}));
  comm.on_root([&] {
    fs::remove(folder + "/fields/mine.h5");
    fs::remove(folder + "/fields/000001.txt");
  });
  expect_same(folder, fresh);
  FieldWriter(folder, comm).write(grid, {}, 0);
  EXPECT_EQ(names(files(folder)), (std::vector<std::string>{"fields.h5", "fields.xdmf"}));
  EXPECT_FALSE(fs::exists(folder + "/fields"));
}

TEST(frames, go_forward_in_time_behind_those_that_were_kept) {
  const core::Comm comm;
  const std::string folder = scratch("frames_order");
  run(folder, 0, 3, comm);
  comm.barrier();
  FieldWriter writer = FieldWriter::series(folder, comm, 3);
  EXPECT_EQ(sentence_of(internal, [&] { write_frame(writer, 2, comm); }).substr(0, 45), "Fields must be written in the order of time; ");
  writer.close();
  EXPECT_EQ(times(folder), (std::vector<double>{0, 1 / 3.0, 2 / 3.0}));
}

TEST(frames, on_a_full_disk_are_an_error_on_all_ranks_and_those_before_stay) {
  const core::Comm comm;
  const std::string folder = scratch("frames_full_disk");
  const Grid small = Strip{3}.grid(comm), large = Strip{20000}.grid(comm);
  FieldWriter writer = FieldWriter::series(folder, comm);
  writer.write(small, {}, 0);
  const auto before = files(folder);
  ::testing::internal::CaptureStderr();
  {
    const FullDisk full(100000);
    const std::string sentence = sentence_of(input_output, [&] { writer.write(large, {}, 1); });
    EXPECT_EQ(sentence.substr(0, 25 + frame(folder, 1).size()), "The file '" + frame(folder, 1) + ".part' can not ");
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(files(folder), before);
  EXPECT_EQ(writer.frames(), 1);
  writer.write(small, {}, 2);
  EXPECT_EQ(times(folder), (std::vector<double>{0, 2}));
}

TEST(frames, without_a_place_are_an_error_on_all_ranks) {
  const core::Comm comm;
  const std::string folder = scratch("frames_places");
  comm.on_root([&] { std::ofstream(folder + "/fields") << "x"; });
  const std::string sentence = sentence_of(input_output, [&] { FieldWriter::series(folder, comm); });
  EXPECT_EQ(sentence.substr(0, 36 + folder.size()), "The folder '" + folder + "/fields' can not be made");
}

TEST(frames, that_are_many_are_all_listed_when_the_run_goes_on_and_in_the_end) {
  const core::Comm comm;
  const std::string folder = scratch("frames_many");
  const Grid grid = Strip{1}.grid(comm);
  {
    FieldWriter writer = FieldWriter::series(folder, comm);
    for (int n = 0; n < 129; ++n) writer.write(grid, {}, n);
    comm.barrier();
    EXPECT_EQ(times(folder).size(), 128u);
    comm.barrier();
  }
  comm.barrier();
  FieldWriter writer = FieldWriter::series(folder, comm, 129);
  EXPECT_EQ(times(folder).size(), 129u);
  comm.barrier();
  writer.write(grid, {}, 129);
  writer.close();
  EXPECT_EQ(times(folder).size(), 130u);
}

TEST(frames, of_segments_and_of_quadrilaterals_go_on_with_the_same_mesh) {
  const core::Comm comm;
  for (const int corners : {2, 4}) {
    const std::string kind = corners == 2 ? "segments" : "quadrilaterals", folder = scratch("for_meshio/frames_of_" + kind),
                      whole = scratch("frames_of_" + kind);
    const Grid grid = other_grid(corners, comm);
    const auto write = [&](FieldWriter& writer, int from, int to) {
      FieldData u{"u", Centre::cell, {}};
      for (int n = from; n < to; ++n) {
        u.values.assign(grid.others.id.begin(), grid.others.id.end());
        for (double& value : u.values) value += n;
        writer.write(grid, {u}, n);
      }
      writer.close();
    };
    FieldWriter uninterrupted = FieldWriter::series(whole, comm), first = FieldWriter::series(folder, comm);
    write(uninterrupted, 0, 3);
    write(first, 0, 2);
    comm.barrier();
    FieldWriter second = FieldWriter::series(folder, comm, 2);
    write(second, 2, 3);
    expect_same(folder, whole);
    EXPECT_EQ(times(folder), (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(read_array(folder + "/fields.h5", "/mesh_0/" + kind).shape, (std::vector<long long>{4, corners}));
    EXPECT_EQ(read_array(folder + "/fields.h5", "/fields_2/u").values, (std::vector<double>{2, 3, 4, 5}));
    EXPECT_TRUE(read_array(folder + "/fields.h5", "/mesh_2/points").shape.empty());
  }
}

TEST(frames, of_a_mesh_that_is_refined_are_left_for_other_readers) {
  const core::Comm comm;
  run(scratch("for_meshio/frames"), 0, 3, comm);
}

}  // namespace thixis::output
