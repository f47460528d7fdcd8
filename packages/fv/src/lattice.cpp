#include "lattice.hpp"

#include <algorithm>
#include <tuple>

namespace thixis::fv {

std::array<double, 2> Lattice::point(double a, double b) const {
  const auto at = [&](int axis, GlobalIndex n, double i) {
    const auto whole = static_cast<double>(n);
    return (lower[axis] * (whole - i) + upper[axis] * i) / whole;
  };
  std::array<double, 2> x{};
  x[axis_a] = at(axis_a, n_a, a);
  x[axis_b] = at(axis_b, n_b, b);
  return x;
}

Lattice lattice(const mesh::MeshParams& params) {
  const auto refined = [&](int cells) { return static_cast<GlobalIndex>(cells) << params.refinements; };
  Lattice result;
  if (params.generator == mesh::Generator::interval) {
    result.dimension = 1;
    result.n_b = refined(params.cells[0]);
    result.lower[0] = params.lower[0];
    result.upper[0] = params.upper[0];
    return result;
  }
  const GlobalIndex n[2] = {refined(params.cells[0]), refined(params.cells[1])};
  result.axis_a = n[0] < n[1] ? 0 : 1;
  result.axis_b = 1 - result.axis_a;
  result.n_a = n[result.axis_a];
  result.n_b = n[result.axis_b];
  for (int d = 0; d < 2; ++d) result.lower[d] = params.lower[d], result.upper[d] = params.upper[d];
  return result;
}

Split split(const Lattice& lattice, int ranks) {
  using Cost = std::tuple<GlobalIndex, double>;
  const auto cost = [&](int parts_a) {
    const int parts_b = ranks / parts_a;
    const GlobalIndex busy = std::min<GlobalIndex>(parts_a, lattice.n_a) * std::min<GlobalIndex>(parts_b, lattice.n_b);
    return Cost(ranks - busy, (parts_a - 1) * static_cast<double>(lattice.n_b) + (parts_b - 1) * static_cast<double>(lattice.n_a));
  };
  int best = 1;
  for (int parts_a = 2; parts_a <= ranks; ++parts_a)
    if (ranks % parts_a == 0 && cost(parts_a) < cost(best)) best = parts_a;
  return {best, ranks / best};
}

GlobalIndex begin(GlobalIndex n, int parts, int k) { return n * k / parts; }
// The largest k with begin(k) <= i, which is n k < (i + 1) parts.
int part_of(GlobalIndex n, int parts, GlobalIndex i) { return static_cast<int>(((i + 1) * parts - 1) / n); }

}  // namespace thixis::fv
