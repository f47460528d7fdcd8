#include "step/way_density.hpp"

#include <algorithm>

namespace thixis::bound {
namespace {

struct DensityOfWay {
  Metrics metric;
  double a_factor, b_factor;
  ConstCellTable a, b;
  CellTable out;
  KOKKOS_FUNCTION void operator()(int K) const {
    for (int m = 0; m < out.extent_int(1); ++m) {
      double sum = 0;
      if (a.extent(0) > 0) sum += a_factor * a(K, m);
      if (b.extent(0) > 0) sum += b_factor * b(K, m);
      out(K, m) = metric(K).det * sum;
    }
  }
};

}  // namespace

bool density_of(const Metrics& metric, double a_factor, const ConstCellTable& a, double b_factor, const ConstCellTable& b,
                const CellTable& out) {
  if (a.extent(0) == 0 && b.extent(0) == 0) return false;
  DensityOfWay kernel;
  kernel.metric = metric;
  kernel.a_factor = a_factor;
  kernel.b_factor = b_factor;
  kernel.a = a;
  kernel.b = b;
  kernel.out = out;
  Kokkos::parallel_for("thixis::bound::density_of_way", Kokkos::RangePolicy<>(0, out.extent_int(0)), kernel);
  return true;
}

void add(double factor, const ConstCellTable& from, const CellTable& to) {
  const int columns = std::min(from.extent_int(1), to.extent_int(1));
  Kokkos::parallel_for(
      "thixis::bound::add", Kokkos::RangePolicy<>(0, to.extent_int(0)), KOKKOS_LAMBDA(int K) {
        for (int i = 0; i < columns; ++i) to(K, i) += factor * from(K, i);
      });
}

}  // namespace thixis::bound
