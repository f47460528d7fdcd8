#include <gtest/gtest.h>

#include "../unit/mesh/msh_files.hpp"
#include "listed_triangles.hpp"
#include "mutate.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/check.hpp"
#include "thixis/mesh/host.hpp"
#include "triangulation.hpp"

namespace thixis::mesh {
namespace {

std::vector<std::string> files() {
  std::vector<std::string> all;
  TwoSquares parts;
  parts.partitioned = true;
  for (const Numbers numbers : {Numbers::text, Numbers::little_endian, Numbers::big_endian})
    for (const auto& mesh : {TwoSquares(), parts}) all.push_back(msh_22(mesh, numbers)), all.push_back(msh_41(mesh, numbers));
  return all;
}

std::multiset<fuzz::Listing::Triangle> triangles_of(const Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  std::multiset<fuzz::Listing::Triangle> found;
  for (LocalIndex K = 0; K < mesh.cells; ++K) {
    fuzz::Listing::Triangle corners;
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d) corners[i][d] = host.coordinates(host.cell_vertices(K, i), d);
    std::sort(corners.begin(), corners.end());
    found.insert(corners);
  }
  return found;
}

bool is_sentence(const std::string& text) {
  return text.size() > 20 && text.back() == '.' &&
         std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x20; });
}

/// Whether the file is read; if so, for what it says.
bool is_read(const std::string& file) {
  try {
    const Triangulation triangulation = gmsh_triangulation(file, "mesh/file: 'damaged.msh'");
    const Mesh mesh = make_mesh(triangulation, core::Comm(MPI_COMM_SELF));
    require_simple_boundary(mesh, triangulation.name);
    EXPECT_EQ(check(mesh), std::vector<std::string>());
    EXPECT_EQ(triangles_of(mesh), fuzz::Listing(file).triangles());
    return true;
  } catch (const core::Error& error) {
    EXPECT_EQ(error.code(), core::ExitCode::input) << error.what();
    EXPECT_TRUE(is_sentence(error.what())) << error.what();
    return false;
  }
}

}  // namespace

TEST(damaged_meshes, are_refused_with_a_sentence_or_read_for_what_they_say) {
  const std::vector<std::string> whole = files();
  for (const auto& file : whole) EXPECT_TRUE(is_read(file));
  const int count = fuzz::mutants(600);
  int read = 0;
  for (int seed = 0; seed < count && !HasFailure(); ++seed) {
    SCOPED_TRACE("mutant " + std::to_string(seed));
    EXPECT_NO_THROW(read += is_read(fuzz::mutant(whole[seed % whole.size()], seed)) ? 1 : 0);
  }
  EXPECT_GT(read, count / 20);
  EXPECT_LT(read, count / 2);
}

}  // namespace thixis::mesh
