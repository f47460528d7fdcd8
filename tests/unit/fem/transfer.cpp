#include "../method/transfers.hpp"
#include "thixis/fem/entry.hpp"

namespace thixis::fem {
namespace {

method::SpaceOptions of_degree(int p, method::Nodes nodes = method::Nodes::gauss_lobatto, int components = 1) {
  method::SpaceOptions options;
  options.params.degree = p;
  options.params.nodes = nodes;
  options.components = components;
  return options;
}

}  // namespace

TEST(Transfer, has_its_transpose) {
  for (int p = 1; p <= 4; ++p)
    for (const bool held : {false, true}) method::expect_adjoint(entry(), of_degree(p), held);
  method::expect_adjoint(entry(), of_degree(3, method::Nodes::bernstein), true);
  method::expect_adjoint(entry(), of_degree(2, method::Nodes::gauss_lobatto, 2), true);
}

TEST(Transfer, keeps_polynomials_of_degree_p_in_every_component) {
  for (int p = 1; p <= 4; ++p) method::expect_components(entry(), of_degree(p));
  method::expect_components(entry(), of_degree(3, method::Nodes::bernstein));
}

TEST(Levels, have_hats_below_every_space) {
  for (int p = 1; p <= 4; ++p) method::expect_hats(entry(), of_degree(p));
  method::expect_hats(entry(), of_degree(3, method::Nodes::bernstein));
}

/// One square across, the coarsest mesh has no vertex that is not held.
TEST(Levels, end_where_no_hat_is_left) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::rectangle;
  params.cells_per_side = 1;
  params.refinements = 2;
  const auto hierarchy = mesh::build(params, core::Comm(), ".");
  for (const int p : {1, 2}) {
    auto options = of_degree(p);
    options.dirichlet.assign(hierarchy.finest().tags.size(), true);
    method::Levels levels(hierarchy, entry(), [&](const mesh::Mesh&) { return options; });
    for (int j = 0; j < 3; ++j) {
      const auto below = levels.below(j);
      EXPECT_EQ(static_cast<int>(below.size()), std::max(0, p == 1 ? j - 1 : j)) << p << ", level " << j;
      for (const auto& P : below) EXPECT_GT(P->getDomainMap()->getGlobalNumElements(), 0u);
    }
  }
}

/// Hats are the basis of P1: their transfer is that of the space, held boundaries included.
TEST(Levels, of_p1_are_hats) {
  const auto hierarchy = method::mixed_levels();
  auto options = of_degree(1);
  options.dirichlet.assign(hierarchy.finest().tags.size(), true);
  method::Levels levels(hierarchy, entry(), [&](const mesh::Mesh&) { return options; });
  for (int j = 1; j < static_cast<int>(hierarchy.levels.size()); ++j) {
    const auto P = levels.below(j).front();
    const auto x = method::some_numbers(*levels.space(j - 1), 3);
    algebra::Vector y(levels.space(j)->map()), z(levels.space(j)->map());
    levels.transfer(j).apply(x, y);
    ASSERT_TRUE(P->getDomainMap()->isSameAs(*x.getMap()));
    P->apply(x, z);
    z.update(-1, y, 1);
    EXPECT_GT(y.normInf(), 0.1);
    EXPECT_LE(z.normInf(), 1e-14) << j;
  }
}

TEST(Levels, are_kept_until_they_are_forgotten) {
  for (const int p : {1, 3}) method::expect_kept(entry(), of_degree(p));
}

}  // namespace thixis::fem
