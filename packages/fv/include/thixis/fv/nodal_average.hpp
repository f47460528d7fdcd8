#pragma once
#include <memory>
#include <vector>

#include "thixis/fv/raviart_thomas.hpp"

namespace thixis::fv {

/// Continuous functions from broken quadratic polynomials: Oswald's averages at the corners of the cells, the midpoints of their faces
/// and the centres of rectangles and intervals, which make up Lagrange's P_2 on intervals and triangles and Q_2 on rectangles. The
/// midpoint of a held face takes the value given there, its corners with what the polynomial behind it changes by towards them (the mean
/// over the held faces around them).
class NodalAverage {
 public:
  /// `held`: per local face. Collective.
  NodalAverage(const Grid& grid, const std::vector<bool>& held);
  ~NodalAverage();
  NodalAverage(const NodalAverage&) = delete;
  NodalAverage& operator=(const NodalAverage&) = delete;

  /// square(K, j) = |grad (p_j - average of p_j)|_K², exactly, overwritten. p: (owned cell, j); given: (local face, j), read on held faces.
  /// Collective.
  void operator()(const View<const Quadratic**>& p, const View<const double**>& given, const View<double**>& square) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::fv
