#pragma once
#include <vector>

#include "thixis/reference/bernstein.hpp"
#include "thixis/reference/lagrange.hpp"

namespace thixis::reference {

enum class Family { gauss_lobatto, equispaced, bernstein };

/// The bases psi_l of P_p, p = 1…4, on a triangle that methods use: Lagrange bases of two families of nodes, and the Bernstein basis.
///
/// Functions are numbered by entity, **those inside first**: inside (0, 0, 1, 3 of them); vertices 0, 1, 2; then the p-1 of faces 0, 1, 2,
/// those of face i from vertex i+1 to vertex i+2 (mod 3). psi_l vanishes on every face on which its entity does not lie, and a
/// polynomial on a face depends on the functions of the face alone. Seen from the other cell of a face its functions run backwards.
///
/// Matrices are flat, row by row.
class CellBasis {
 public:
  /// Throws InputError unless 1 <= degree <= 4.
  CellBasis(int degree, Family family);

  int degree() const { return degree_; }
  int size() const { return bernstein_.size; }  ///< n = (p+1)(p+2)/2
  int interior() const { return interior_; }    ///< functions inside: the first ones
  Family family() const { return family_; }
  const std::vector<NodeEntity>& entities() const { return entities_; }  ///< of every function

  /// Points x_l, flat [n][2], and the way from values there to coefficients, u = sum_l c_l psi_l, c = from_values · u(x): the identity for
  /// Lagrange bases. Bernstein: the Gauss–Lobatto family; coefficients of a face come from values on that face.
  const std::vector<double>& points() const { return points_; }
  const std::vector<double>& from_values() const { return from_values_; }
  /// The regular lattice in the same order, flat [n][2]: where output shows the field.
  const std::vector<double>& lattice() const { return lattice_; }

  /// psi_l = sum_k C_kl B_k: Bernstein coefficients of u are C c.
  const std::vector<double>& to_bernstein() const { return to_bernstein_; }
  void to_bernstein(const double* c, double* bernstein) const {
    for (int k = 0; k < size(); ++k) {
      bernstein[k] = 0;
      for (int l = 0; l < size(); ++l) bernstein[k] += to_bernstein_[k * size() + l] * c[l];
    }
  }
  const Bernstein& bernstein() const { return bernstein_; }

  const std::vector<double>& integrals() const { return integrals_; }  ///< (psi_l, 1) on the reference triangle; they sum to 1/2
  const std::vector<double>& mass() const { return mass_; }            ///< (psi_l, psi_m) there

  /// Values and derivatives in xi, eta at `count` points, flat [count][2].
  Tabulation tabulate(int count, const double* points) const;

 private:
  int degree_, interior_;
  Family family_;
  Bernstein bernstein_;
  std::vector<NodeEntity> entities_;
  std::vector<double> points_, lattice_, from_values_, to_bernstein_, integrals_, mass_;
};

/// The Bernstein basis of degree 0 … 4, in the order of its exponents.
Bernstein bernstein(int degree);

/// Inverse of a regular matrix, flat, row by row.
std::vector<double> inverse(int size, const std::vector<double>& matrix);

}  // namespace thixis::reference
