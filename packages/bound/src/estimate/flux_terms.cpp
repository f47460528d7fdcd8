#include "estimate/flux_terms.hpp"

#include "estimate/square.hpp"

namespace thixis::bound {

KOKKOS_FUNCTION double FluxTerms::oscillation(int K) const {
  double left = 0;
  if (of_multiplier.extent(0) > 0) left += poincare(K) * of_multiplier(K);
  if (of_rate.extent(0) > 0) left += poincare(K) * of_rate(K);
  return volume(K) + traction(K) + left;
}

KOKKOS_FUNCTION void FluxTerms::operator()(int K, Sums<OfFlux>& sum) const {
  const double left = oscillation(K), c2 = change.extent(0) > 0 ? squared(change(K)) : 0;
  const double of_disc = squared(root(squared(norms.disc(K)) + c2 / 12) + left), of_lin = squared(norms.lin(K)),
               of_alg = squared(norms.alg(K));
  sum[OfFlux::whole] += squared(root(squared(norms.whole(K)) + c2 / 12) + left);
  sum[OfFlux::disc] += of_disc;
  sum[OfFlux::lin] += of_lin;
  sum[OfFlux::alg] += of_alg;
  sum[OfFlux::change] += c2 / 3;
  if (add.disc.extent(0) == 0) return;
  add.disc(K) += of_disc;
  add.lin(K) += of_lin;
  add.alg(K) += of_alg;
}

FluxTerms flux_terms(const MembraneFlux& of, const View<const double*>& of_multiplier) {
  FluxTerms terms;
  terms.norms = of.norms;
  terms.volume = of.data.sharp_oscillation;
  terms.traction = of.data.traction_oscillation;
  terms.poincare = of.poincare;
  terms.of_multiplier = of_multiplier;
  return terms;
}

}  // namespace thixis::bound
