#include "problem/increments.hpp"

#include <algorithm>

#include "step/extremes.hpp"
#include "step/vectors.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

constexpr double most_saturation = 0.2;  // of one increment
constexpr double most_growth = 10;       // of pressures and molar fractions
constexpr double beyond = 1e-3;          // a corner, of the distance between the two

KOKKOS_INLINE_FUNCTION double clamped(double value, double most) { return value > most ? most : value < -most ? -most : value; }

KOKKOS_INLINE_FUNCTION double end_of(const TwoPhaseLaws& laws, double s_g, double increment) {
  const double to = s_g + clamped(increment, most_saturation);
  if (!(laws.S_gr > 0)) return to;  // there the line of the laws ends where gas appears, which the contact conditions know
  const double width = laws.eps * laws.width, low = laws.S_gr, high = low + width, past = beyond * width;
  const double next = s_g < low ? low : high, last = s_g > high ? high : low;
  if (s_g < next && to > next + past) return next + past;
  if (s_g > last && to < last - past) return last - past;
  return to;
}

struct Left {
  algebra::Matrix::local_matrix_device_type A;
  VectorIn r;
  KOKKOS_FUNCTION void operator()(LocalIndex i, double& largest) const {
    const auto row = A.rowConst(i);
    double entry = 0;
    for (LocalIndex k = 0; k < row.length; ++k) entry = Kokkos::Experimental::fmax(entry, Kokkos::Experimental::fabs(row.value(k)));
    if (entry > 0) largest = Kokkos::Experimental::fmax(largest, Kokkos::Experimental::fabs(r(i, 0)) / entry);
  }
};

struct Shorten {
  TwoPhaseLaws laws;
  double most_pressure, most_dissolved;
  VectorIn x;
  VectorOut d;  ///< in and out

  KOKKOS_FUNCTION void operator()(LocalIndex K, int& changed) const {
    const LocalIndex k = unknowns_per_cell * K;
    const double s_g = x(k + gas_saturation, 0), whole = d(k + gas_saturation, 0);
    const double end = end_of(laws, s_g, whole);
    if (end != s_g + whole) set(k + gas_saturation, end - s_g, changed);
    set(k + pressure, clamped(d(k + pressure, 0), most_pressure), changed);
    set(k + dissolved, clamped(d(k + dissolved, 0), most_dissolved), changed);
  }
  KOKKOS_INLINE_FUNCTION void set(LocalIndex k, double value, int& changed) const {
    if (value != d(k, 0)) ++changed;
    d(k, 0) = value;
  }
};

}  // namespace

double largest_left(const algebra::Matrix& A, const Vector& r) {
  double most = 0;
  Kokkos::parallel_reduce("thixis::flow::largest_left", Cells(0, algebra::local_rows(A)), Left{A.getLocalMatrixDevice(), read(r)},
                          Kokkos::Max<double>(most));
  return algebra::comm_of(*A.getRowMap()).max(most);
}

double end_of_saturation(const TwoPhaseLaws& laws, double s_g, double increment) { return end_of(laws, s_g, increment); }

bool shortened(const TwoPhaseLaws& laws, const double unknown[unknowns_per_cell], const Vector& X, Vector& dX) {
  const auto most = [&](Unknown u) { return most_growth * std::max(unknown[u], largest(X, u)); };
  int changed = 0;
  Kokkos::parallel_reduce("thixis::flow::shorten", Cells(0, static_cast<LocalIndex>(X.getLocalLength()) / unknowns_per_cell),
                          Shorten{laws, most(pressure), most(dissolved), read(X), write(dX)}, changed);
  return !algebra::comm_of(*X.getMap()).all(changed == 0);
}

}  // namespace thixis::flow
