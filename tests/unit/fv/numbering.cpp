#include <algorithm>
#include <map>
#include <set>

#include "grids.hpp"

namespace thixis::fv {
namespace {

class Numbering : public ::testing::TestWithParam<Sample> {
 protected:
  const core::Comm comm;
  const Grid grid = GetParam().make(comm), all = whole(GetParam());
  const HostGrid at = on_host(grid), at_all = on_host(all);
};

std::string title(const ::testing::TestParamInfo<Sample>& info) {
  std::string text;
  for (const char c : info.param.name) text += c == ' ' ? '_' : c == ',' ? 'x' : c;
  return text;
}

template <class V>
void expect_equal_rows(const V& part, LocalIndex i, const V& all, GlobalIndex id) {
  for (std::size_t d = 0; d < part.extent(1); ++d) EXPECT_EQ(part(i, d), all(id, d)) << id;
}

bool rising(const std::vector<GlobalIndex>& id, LocalIndex begin, LocalIndex end) {
  return std::adjacent_find(id.begin() + begin, id.begin() + end, std::greater_equal<GlobalIndex>()) == id.begin() + end;
}

}  // namespace

TEST_P(Numbering, of_one_rank_is_the_global_one) {
  for (const auto& [id, total] : {std::pair(all.cell_id, all.global_cells), std::pair(all.face_id, all.global_faces),
                                  std::pair(all.vertex_id, all.global_vertices)}) {
    ASSERT_EQ(static_cast<GlobalIndex>(id.size()), total);
    for (GlobalIndex i = 0; i < total; ++i) ASSERT_EQ(id[i], i);
  }
  // Euler: cells - faces + vertices = 1 for domains without holes.
  EXPECT_EQ(all.global_cells - all.global_faces + all.global_vertices, all.dimension == 1 ? all.global_cells : 1);
}

TEST_P(Numbering, and_geometry_are_the_same_on_any_number_of_ranks) {
  EXPECT_EQ(grid.tags, all.tags);
  for (LocalIndex K = 0; K < grid.cells; ++K) {
    const GlobalIndex id = grid.cell_id[K];
    expect_equal_rows(at.centre, K, at_all.centre, id);
    expect_equal_rows(at.barycentre, K, at_all.barycentre, id);
    EXPECT_EQ(at.volume(K), at_all.volume(id));
    EXPECT_EQ(at.diameter(K), at_all.diameter(id));
    for (int i = 0; i < grid.corners(); ++i) EXPECT_EQ(grid.vertex_id[at.cell_vertices(K, i)], at_all.cell_vertices(id, i));
  }
  for (LocalIndex F = 0; F < grid.faces; ++F) {
    const GlobalIndex id = grid.face_id[F];
    expect_equal_rows(at.face_centre, F, at_all.face_centre, id);
    expect_equal_rows(at.face_normal, F, at_all.face_normal, id);
    EXPECT_EQ(at.face_area(F), at_all.face_area(id));
    EXPECT_EQ(at.face_distance(F), at_all.face_distance(id));
    EXPECT_EQ(at.face_tag(F), at_all.face_tag(id));
    for (int side = 0; side < 2; ++side) {
      const LocalIndex K = at.face_cells(F, side);
      EXPECT_EQ(K < 0 ? -1 : grid.cell_id[K], at_all.face_cells(id, side));
    }
  }
  for (LocalIndex v = 0; v < grid.vertices; ++v) expect_equal_rows(at.vertex, v, at_all.vertex, grid.vertex_id[v]);
}

TEST_P(Numbering, rises_on_every_rank) {
  EXPECT_TRUE(rising(grid.cell_id, 0, grid.owned_cells));
  EXPECT_TRUE(rising(grid.cell_id, grid.owned_cells, grid.cells));
  EXPECT_TRUE(rising(grid.face_id, 0, grid.faces));
  EXPECT_TRUE(rising(grid.vertex_id, 0, grid.vertices));
  ASSERT_EQ(at.cell_face_begin(0), 0);
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
    ASSERT_EQ(at.cell_face_begin(K + 1) - at.cell_face_begin(K), grid.corners());
    for (LocalIndex k = at.cell_face_begin(K) + 1; k < at.cell_face_begin(K + 1); ++k) EXPECT_LT(at.cell_faces(k - 1), at.cell_faces(k));
  }
}

TEST_P(Numbering, owners_are_known_alike_by_all) {
  std::vector<GlobalIndex> mine(grid.cell_id.begin(), grid.cell_id.begin() + grid.owned_cells);
  std::vector<int> owner(grid.global_cells, -1);
  const auto ids = comm.gather(mine);
  const auto counts = comm.gather(grid.owned_cells);
  ASSERT_EQ(static_cast<GlobalIndex>(ids.size()), grid.global_cells);
  for (std::size_t k = 0, rank = 0, end = counts[0]; k < ids.size(); ++k) {
    while (k == end) end += counts[++rank];
    EXPECT_EQ(owner[ids[k]], -1);
    owner[ids[k]] = static_cast<int>(rank);
  }
  for (LocalIndex K = 0; K < grid.cells; ++K) {
    EXPECT_EQ(grid.cell_owner[K], owner[grid.cell_id[K]]);
    EXPECT_EQ(grid.cell_owner[K] == comm.rank(), K < grid.owned_cells);
  }
}

TEST_P(Numbering, ghosts_are_the_cells_that_share_a_vertex_with_an_owned_one) {
  std::set<GlobalIndex> owned(grid.cell_id.begin(), grid.cell_id.begin() + grid.owned_cells), vertices, wanted, found;
  for (const GlobalIndex id : owned)
    for (int i = 0; i < all.corners(); ++i) vertices.insert(at_all.cell_vertices(id, i));
  for (GlobalIndex id = 0; id < all.global_cells; ++id)
    for (int i = 0; i < all.corners(); ++i)
      if (vertices.count(at_all.cell_vertices(id, i))) wanted.insert(id);
  for (const GlobalIndex id : owned) wanted.erase(id);
  found.insert(grid.cell_id.begin() + grid.owned_cells, grid.cell_id.end());
  EXPECT_EQ(found, wanted);
}

TEST_P(Numbering, faces_are_those_of_the_owned_cells) {
  std::set<GlobalIndex> wanted, listed(grid.face_id.begin(), grid.face_id.end());
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
    const GlobalIndex id = grid.cell_id[K];
    for (LocalIndex k = 0; k < grid.corners(); ++k) {
      const GlobalIndex face = at_all.cell_faces(id * grid.corners() + k);
      wanted.insert(face);
      EXPECT_EQ(grid.face_id[at.cell_faces(at.cell_face_begin(K) + k)], face);
    }
  }
  EXPECT_EQ(listed, wanted);
}

INSTANTIATE_TEST_SUITE_P(grids, Numbering, ::testing::ValuesIn(samples()), title);

TEST(numbering, of_tensor_grids_runs_along_the_shorter_side_first) {
  for (const auto& params : {tensor_params(40, 7), tensor_params(7, 40)}) {
    const Grid grid = fv::build(params, core::Comm(), ".");
    const HostGrid at = on_host(grid);
    for (LocalIndex F = 0; F < grid.faces; ++F) {
      const LocalIndex K = at.face_cells(F, 0), L = at.face_cells(F, 1);
      if (L < 0) continue;
      EXPECT_LE(grid.cell_id[L] - grid.cell_id[K], 7);
    }
  }
}

}  // namespace thixis::fv
