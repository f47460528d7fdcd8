#pragma once
#include <gtest/gtest.h>

#include "thixis/mesh/ancestry.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::mesh {

/// What an ancestry promises: shapes handed down from the root give the corners of the cells (in the parameter domain), areas summed up
/// over children, and over the ranks in shared levels, those of the root.
inline void expect_lineage(const Hierarchy& hierarchy, int level) {
  const Ancestry lineage = ancestry(hierarchy, level);
  const Mesh &mesh = hierarchy.levels[level], &root = *lineage.root;
  const HostMesh host = on_host(mesh), coarse = on_host(root);
  ASSERT_EQ(static_cast<int>(lineage.levels.size()), level);
  ASSERT_EQ(lineage.leaf.size(), static_cast<std::size_t>(mesh.owned_cells));

  using Triangle = std::array<std::array<double, 2>, 3>;
  std::vector<Triangle> corners(root.cells);
  for (LocalIndex K = 0; K < root.cells; ++K)
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d) corners[K][i][d] = coarse.parameter(coarse.cell_vertices(K, i), d);
  for (const Ancestry::Level& list : lineage.levels) {
    std::vector<Triangle> finer(list.parent.size(), Triangle{});
    for (std::size_t k = 0; k < finer.size(); ++k)
      for (int i = 0; i < 3; ++i)
        for (int a = 0; a < 3; ++a)
          for (int d = 0; d < 2; ++d) finer[k][i][d] += child_shapes()[list.shape[k]][i][a] * corners.at(list.parent[k])[a][d];
    corners = std::move(finer);
  }
  double distance = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d)
        distance = std::max(distance, std::abs(corners.at(lineage.leaf[K])[i][d] - host.parameter(host.cell_vertices(K, i), d)));
  EXPECT_LT(distance, 1e-13);

  std::vector<double> area(corners.size(), 0);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) area[lineage.leaf[K]] = cell_area(host.parameter, host.cell_vertices, K);
  for (int j = level; j >= 0; --j) {
    if (j == lineage.shared && mesh.comm.size() > 1) mesh.comm.sum(area);
    if (j == 0) break;
    const Ancestry::Level& list = lineage.levels[j - 1];
    std::vector<double> sum(j == 1 ? root.cells : lineage.levels[j - 2].parent.size(), 0);
    for (std::size_t k = 0; k < area.size(); ++k) sum[list.parent[k]] += area[k];
    area = std::move(sum);
  }
  double wrong = 0;
  for (LocalIndex K = 0; K < root.cells; ++K)
    wrong = std::max(wrong, std::abs(area[K] / cell_area(coarse.parameter, coarse.cell_vertices, K) - 1));
  EXPECT_LT(wrong, 1e-12);
}

}  // namespace thixis::mesh
