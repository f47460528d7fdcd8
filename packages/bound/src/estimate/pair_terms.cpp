#include "estimate/pair_terms.hpp"

#include "estimate/square.hpp"

namespace thixis::bound {

KOKKOS_FUNCTION void PairTerms::operator()(int K, Sums<OfPair>& sum) const {
  const double rest2 = squared(rest(K)), nodes2 = squared(at_nodes(K)), together = contact(K), at_points = contact_lin(K);
  sum[OfPair::whole] += squared(whole(K));
  sum[OfPair::rest] += rest2;
  sum[OfPair::at_nodes] += nodes2;
  sum[OfPair::contact] += together;
  sum[OfPair::contact_at_points] += at_points;
  cells.discretization(K) = root(cells.discretization(K) + rest2 + 2 * magnitude(together - at_points));
  cells.linearization(K) = root(cells.linearization(K) + nodes2 + 2 * at_points);
  cells.algebraic(K) = root(cells.algebraic(K));
}

}  // namespace thixis::bound
