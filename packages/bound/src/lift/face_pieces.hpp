#pragma once
#include <vector>

#include "lift/lift_tables.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::bound {

/// A face of a cell cut into equal pieces, with the functions on it at their ends.
class FacePieces {
 public:
  static constexpr int count = 64;

  explicit FacePieces(const reference::CellBasis& basis);
  static double s(int m) { return static_cast<double>(m) / count; }

  /// g <- g - g_h at the ends of the pieces of face i; `u`: coefficients in the cell.
  void subtract(int i, const double* u, std::vector<double>& g) const;
  /// delta <- rho.
  void subtract_lift(const LiftInCell::Series& q, std::vector<double>& delta) const;
  /// ∫_K |grad E|² of the extension of rho from the face from a to b into the triangle with the third vertex c.
  static double energy(const std::vector<double>& rho, const double (&a)[2], const double (&b)[2], const double (&c)[2]);

 private:
  int functions_;
  std::vector<double> trace_[3], legendre_;
};

/// The values at s, flat (point, l), of the functions of a cell on its face i, s from vertex i + 1 to i + 2.
std::vector<double> traces(const reference::CellBasis& basis, int i, const std::vector<double>& s);
/// (point, j): orthonormal Legendre polynomials up to LiftInCell::resolution at s.
std::vector<double> legendre_at(const std::vector<double>& s);

}  // namespace thixis::bound
