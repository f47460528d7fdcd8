#include "refine/marking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "thixis/mesh/build.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::drive::test {
namespace {

/// 1024 cells, shared out to the ranks.
mesh::Hierarchy hierarchy() {
  mesh::MeshParams params;
  params.cells_per_side = 16;
  params.cells_per_rank = 1;
  return mesh::build(params, core::Comm(), ".");
}

constexpr GlobalIndex cells = 1024;
using Eta = double (*)(GlobalIndex);
double singular(GlobalIndex id) { return 1.0 / (1 + (37 * id) % 1024); }

std::vector<GlobalIndex> marked(Eta eta, const AdaptParams& params, double noise = 0) {
  const mesh::Hierarchy levels = hierarchy();
  const mesh::Mesh& mesh = levels.finest();
  std::vector<double> values;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) values.push_back(eta(mesh.cell_id[K]) * (1 + noise * (K % 7)));
  return mark(mesh, params, values);
}

double squares(const std::vector<GlobalIndex>& ids, Eta eta) {
  double sum = 0;
  for (const GlobalIndex id : ids) sum += eta(id) * eta(id);
  return sum;
}

std::vector<GlobalIndex> all() {
  std::vector<GlobalIndex> ids(cells);
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

TEST(Marking, takes_the_fewest_cells_that_hold_the_share) {
  for (const double theta : {0.1, 0.5, 0.9}) {
    AdaptParams params;
    params.theta = theta;
    const auto ids = marked(singular, params);
    const double sum = squares(ids, singular), wanted = theta * theta * squares(all(), singular);
    EXPECT_GE(sum, wanted * (1 - 1e-5));
    double smallest = std::numeric_limits<double>::infinity();
    for (const GlobalIndex id : ids) smallest = std::min(smallest, singular(id));
    EXPECT_LT(sum - smallest * smallest, wanted);
    for (const GlobalIndex id : all()) EXPECT_TRUE(singular(id) <= smallest || std::binary_search(ids.begin(), ids.end(), id));
  }
}

TEST(Marking, does_not_depend_on_the_ranks_and_on_round_off) {
  AdaptParams params;
  const auto ids = marked(singular, params);
  EXPECT_EQ(ids, marked(singular, params, 1e-14));
  EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
  const auto everywhere = core::Comm().gather(ids);
  for (std::size_t i = 0; i < everywhere.size(); ++i) EXPECT_EQ(everywhere[i], ids[i % ids.size()]);
  // what a single rank would do, found by another way
  std::vector<GlobalIndex> sorted = all(), expected;
  std::sort(sorted.begin(), sorted.end(), [](GlobalIndex a, GlobalIndex b) { return singular(a) > singular(b); });
  for (const GlobalIndex id : sorted)
    if (squares(expected, singular) < 0.25 * squares(all(), singular)) expected.push_back(id);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(ids, expected);
}

TEST(Marking, takes_equal_cells_in_the_order_of_their_ids) {
  AdaptParams params;
  const auto ids = marked([](GlobalIndex) { return 0.3; }, params, 1e-13);
  ASSERT_EQ(ids.size(), 256u);  // theta² of 1024
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(ids[i], static_cast<GlobalIndex>(i));
}

TEST(Marking, theta_one_and_uniform_take_all_cells) {
  AdaptParams params;
  params.theta = 1;
  EXPECT_EQ(marked(singular, params), all());
  params.marking = Marking::uniform, params.theta = 0.1;
  EXPECT_EQ(marked(singular, params), all());
}

TEST(Marking, nothing_where_there_is_no_error) {
  for (const Marking marking : {Marking::dorfler, Marking::uniform}) {
    AdaptParams params;
    params.marking = marking;
    EXPECT_TRUE(marked([](GlobalIndex) { return 0.0; }, params).empty());
  }
}

TEST(Marking, an_estimate_that_is_not_a_number_ends_the_run_on_all_ranks) {
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const mesh::Hierarchy levels = hierarchy();
    const mesh::Mesh& mesh = levels.finest();
    std::vector<double> eta(mesh.owned_cells, 1.0);
    if (mesh.comm.root()) eta[0] = wrong;
    EXPECT_THROW(mark(mesh, {}, eta), core::Error);
  }
}

TEST(Marking, cells_at_round_off_are_not_refined) {
  mesh::Hierarchy levels = hierarchy();
  mesh::Mesh& mesh = levels.levels.back();
  EXPECT_EQ(refinable(mesh, all()), all());
  EXPECT_TRUE(refinable(mesh, {}).empty());
  // all vertices but those of the side x = 1 drawn together
  const auto host = mesh::on_host(mesh);
  for (LocalIndex v = 0; v < mesh.vertices; ++v)
    if (host.coordinates(v, 0) < 1 - 1e-12)
      for (int i = 0; i < 2; ++i) host.coordinates(v, i) *= 1e-8;
  mesh::commit(host, mesh);
  std::vector<GlobalIndex> touching;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i)
      if (host.coordinates(host.cell_vertices(K, i), 0) > 0.5) {
        touching.push_back(mesh.cell_id[K]);
        break;
      }
  touching = mesh.comm.gather(touching);
  std::sort(touching.begin(), touching.end());
  EXPECT_EQ(refinable(mesh, all()), touching);
}

TEST(Marking, owned_cells_are_found_by_their_ids) {
  const mesh::Hierarchy levels = hierarchy();
  const mesh::Mesh& mesh = levels.finest();
  const auto ids = marked(singular, {});
  const auto own = owned(mesh, ids);
  for (const LocalIndex K : own) EXPECT_TRUE(std::binary_search(ids.begin(), ids.end(), mesh.cell_id[K]));
  EXPECT_EQ(mesh.comm.sum(static_cast<long long>(own.size())), static_cast<long long>(ids.size()));
}

}  // namespace
}  // namespace thixis::drive::test
