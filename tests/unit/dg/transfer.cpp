#include "../method/transfers.hpp"
#include "thixis/dg/entry.hpp"

namespace thixis::dg {
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

TEST(Levels, are_kept_until_they_are_forgotten) {
  for (const int p : {1, 3}) method::expect_kept(entry(), of_degree(p));
}

}  // namespace thixis::dg
