#include "thixis/method/jumps.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "thixis/mesh/build.hpp"
#include "thixis/scene/shifted.hpp"

namespace thixis::method {
namespace {

mesh::Mesh square_at(double x, double y) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::rectangle;
  params.cells_per_side = 8;
  params.lower = {x, y};
  params.upper = {x + 1, y + 1};
  return mesh::build(params, core::Comm(), ".").levels.back();
}

/// On all ranks: cells in which f jumps, heights counted from `origin`.
long long jumps(const mesh::Mesh& mesh, const std::string& f, double origin = 0) {
  const auto field = scene::shifted(scene::expression("f", f, {0, 0}, {}), -origin);
  const Jumps found = jumps_in_cells(make_quadrature(mesh, owned_cells(mesh), 6, nullptr), *field, 0);
  long long count = 0;
  for (const auto& range : found.of_cells) count += range.jumps;
  return mesh.comm.sum(count);
}

}  // namespace

TEST(Jumps, are_found_wherever_the_function_and_the_mesh_are) {
  for (const double place : {0.0, 1e3, 1e6})
    for (const double height : {0.0, 1.0, 1e6}) {
      const auto mesh = square_at(place, -place);
      const std::string step = fmt::format("{} + (x < {} ? 0.1 : 0)", height, place + 0.3);
      const std::string slope = fmt::format("{} - 0.05 - 0.01*(x - {}) + 0.02*(y + {})", height, place, place);
      const std::string curve = fmt::format("{} + 0.3*(x - {})^2", height, place);
      EXPECT_EQ(jumps(mesh, step, height), 16) << place << ", " << height;
      EXPECT_EQ(jumps(mesh, slope, height), 0) << place << ", " << height;
      EXPECT_EQ(jumps(mesh, curve, height), 0) << place << ", " << height;
    }
}

}  // namespace thixis::method
