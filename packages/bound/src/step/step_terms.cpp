#include "step/step_terms.hpp"

#include "estimate/square.hpp"

namespace thixis::bound {
namespace {

/// ∫_0^1 |(1 - theta) a + theta b|² where |a|, |b| are known: exact where one is a multiple of the other.
KOKKOS_INLINE_FUNCTION double mean_square(double a, double b) { return (a * a + a * b + b * b) / 3; }

}  // namespace

/// The contact term of d.
KOKKOS_FUNCTION double StepTerms::add_bulge(int K, Sums<OfStep>& sum) const {
  if (bulge.energy.extent(0) == 0) return 0;
  const int modes = lambda.extent_int(1) < bulge.gap.extent_int(1) ? lambda.extent_int(1) : bulge.gap.extent_int(1);
  double product = 0;
  for (int m = 0; m < modes; ++m) product += lambda(K, m) * bulge.gap(K, m);
  sum[OfStep::contact_of_bulge] += product;
  for (int alpha = 0; alpha < count; ++alpha) sum[OfStep::bulge_1 + alpha] += squared(bulge.size(K, alpha));
  return product;
}

KOKKOS_FUNCTION void StepTerms::operator()(int K, Sums<OfStep>& sum) const {
  const double more = bulge.energy.extent(0) > 0 ? root(bulge_square) * bulge.energy(K) : 0;
  const double rest2 = squared(root(mean_square(whole_then(K), rest(K))) + more), nodes2 = squared(at_nodes(K)) / 3;
  const double together = contact(K) + contact_then(K) + 2 * bulge_mean * add_bulge(K, sum), at_points = contact_lin(K);
  sum[OfStep::pair] += squared(root(mean_square(whole_then(K), whole(K))) + more);
  sum[OfStep::rest] += rest2;
  sum[OfStep::rest_at_end] += squared(rest(K));
  sum[OfStep::at_nodes] += nodes2;
  sum[OfStep::contact] += contact(K);
  sum[OfStep::contact_then] += contact_then(K);
  sum[OfStep::contact_at_points] += at_points;
  sum[OfStep::moved] += squared(move_change(K));
  for (int alpha = 0; lift_change.extent(0) > 0 && alpha < count; ++alpha) sum[OfStep::lift_1 + alpha] += squared(lift_change(K, alpha));
  const double unbalanced = of_move * squared(move_change(K));
  cells.discretization(K) = root(tau * (cells.discretization(K) + rest2 + magnitude(together - at_points)) + unbalanced / tau);
  cells.linearization(K) = root(tau * (cells.linearization(K) + nodes2 + at_points));
  cells.algebraic(K) = root(tau * cells.algebraic(K));
}

}  // namespace thixis::bound
