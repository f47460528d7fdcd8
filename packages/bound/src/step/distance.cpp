#include "step/distance.hpp"

#include <cmath>

#include "estimate/square.hpp"

namespace thixis::bound {
namespace {

struct OfDistance {
  enum { way, rest, count };
};

struct DistanceTerms {
  Metrics metric;
  ConstCellTable averages, closing;  ///< of length 0: zero
  View<const double* [2]> lifted;    ///< of length 0: zero
  View<const double*> moved;
  double apart;
  int alpha, functions;
  KOKKOS_FUNCTION void operator()(int K, Sums<OfDistance>& sum) const {
    for (int m = 0; m < functions; ++m) {
      double value = 0;
      if (averages.extent(0) > 0) value += averages(K, m);
      if (closing.extent(0) > 0) value += closing(K, m);
      sum[OfDistance::way] += metric(K).det * value * value;
    }
    sum[OfDistance::rest] += squared(apart * moved(K) + (lifted.extent(0) > 0 ? lifted(K, alpha) : 0));
  }
};

}  // namespace

std::array<double, 2> distance(const BoundParts& parts, const FeasiblePair& pair, const method::Coefficients (&u)[2],
                               const View<double*>& moved) {
  const auto way = pair.way(u, pair.continuous(u));
  pair.change_of_move(way.gap, {}, nullptr, {}, moved);
  DistanceTerms terms;
  terms.metric = parts.metric;
  terms.lifted = pair.change_of_lift(nullptr);
  terms.moved = moved;
  terms.functions = parts.space.basis().size();
  std::array<double, 2> norm = {0, 0};
  for (int alpha = 0; alpha < parts.problem.count; ++alpha) {
    terms.averages = way.averages[alpha];
    terms.closing = way.closing[alpha];
    terms.apart = pair.apart()[alpha];
    terms.alpha = alpha;
    const auto sum = sum_over_cells<OfDistance>("thixis::bound::distance", parts.owned(), terms).over(parts.comm());
    norm[alpha] = std::sqrt(sum[OfDistance::way]) + std::sqrt(sum[OfDistance::rest]);
  }
  return norm;
}

}  // namespace thixis::bound
