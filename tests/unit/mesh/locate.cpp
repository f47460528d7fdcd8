#include "thixis/mesh/locate.hpp"

#include <gtest/gtest.h>

#include "meshes.hpp"

namespace thixis::mesh {
namespace {

/// The point of a place, from the rank that has it.
std::array<double, 2> point_of(const Mesh& mesh, const Place& place) {
  const HostMesh host = on_host(mesh);
  std::vector<double> point(2, 0);
  if (place.cell >= 0) {
    const double lambda[3] = {1 - place.xi - place.eta, place.xi, place.eta};
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d) point[d] += lambda[i] * host.coordinates(host.cell_vertices(place.cell, i), d);
  }
  mesh.comm.sum(point);
  return {point[0], point[1]};
}

const std::vector<std::array<double, 2>> inside = {{0.1, 0.2}, {0, 0}, {0.5, 0}, {-0.3, 0.4}, {1, 0}, {0.25, -0.7}};

}  // namespace

TEST(locate, finds_one_cell_on_one_rank_for_every_point_of_the_mesh) {
  const Mesh mesh = disk(2, 2).finest();
  const auto places = locate(mesh, inside);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    EXPECT_TRUE(places[i].inside);
    EXPECT_EQ(mesh.comm.sum(places[i].cell >= 0 ? 1 : 0), 1);
    const auto found = point_of(mesh, places[i]);
    for (int d = 0; d < 2; ++d) EXPECT_NEAR(found[d], inside[i][d], 1e-12);
  }
}

TEST(locate, takes_the_cell_of_the_lowest_id_for_points_between_cells) {
  const Mesh mesh = disk(2, 1).finest();
  const HostMesh host = on_host(mesh);
  const auto place = locate(mesh, {{0, 0}}).front();
  GlobalIndex lowest = mesh.global_cells;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i)
      if (const LocalIndex v = host.cell_vertices(K, i); host.coordinates(v, 0) == 0 && host.coordinates(v, 1) == 0)
        lowest = std::min(lowest, mesh.cell_id[K]);
  lowest = mesh.comm.min(lowest);
  EXPECT_EQ(mesh.comm.max(place.cell >= 0 ? mesh.cell_id[place.cell] : -1LL), lowest);
}

TEST(locate, knows_what_lies_outside) {
  const Mesh mesh = disk(2, 2).finest();
  for (const auto& place : locate(mesh, {{1.01, 0}, {0.999 * 0.5, 0.999 * 0.99}})) {
    EXPECT_FALSE(place.inside);
    EXPECT_EQ(place.cell, -1);
  }
}

}  // namespace thixis::mesh
