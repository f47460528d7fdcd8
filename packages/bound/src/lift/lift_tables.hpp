#pragma once
#include <array>
#include <vector>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/reference/bernstein.hpp"

namespace thixis::bound {

/// A lift in one cell by its coefficients (docs/methods/estimates.md, 4.3): v in Bernstein polynomials, and for each held face i of the
/// cell with ends j, k the polynomial q of l = lambda_j lambda_k q(lambda_k + lambda_i/2) in Legendre polynomials, orthonormal on [0,1].
struct LiftInCell {
  static constexpr int resolution = 10;  ///< degree of q
  using Series = std::array<double, resolution + 1>;

  std::array<double, reference::max_functions> v = {};
  int faces = 0;
  int face[3];
  Series q[3];
};

/// sum_j q_j L_j(s) and its derivative.
std::array<double, 2> series(const LiftInCell::Series& q, double s);

/// The functions that lifts are made of, at points of the reference triangle that many cells share.
class LiftTable {
 public:
  LiftTable(const reference::Bernstein& of_v, const View<const double* [2]>& xi);

  int points() const { return points_; }
  /// Values and derivatives in xi, eta of a lift at the points.
  void evaluate(const LiftInCell& lift, std::vector<double> (&out)[3]) const;

 private:
  int points_, size_;
  std::vector<double> v_[3];           ///< (point, k): of B_k
  std::vector<double> of_face_[3][3];  ///< [face][·]: (point, m): of lambda_j lambda_k L_m(lambda_k + lambda_i/2)
};

}  // namespace thixis::bound
