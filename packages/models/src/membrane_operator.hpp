#pragma once
#include <array>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/method/space.hpp"

namespace thixis::models {

/// The linear part of the two-membrane problem on one space with N unknowns:
///
///     E(X) - F = [ S1 u1 - D lambda - F1 ;  S2 u2 + D lambda - F2 ],     S_alpha = factor_alpha · matrix_alpha.
///
/// Where both tensions are constant, both matrices are one, that of the unit tension.
struct MembraneOperator {
  std::array<Teuchos::RCP<const algebra::Matrix>, 2> matrix;
  std::array<double, 2> factor = {1, 1};
  std::array<Teuchos::RCP<algebra::Vector>, 2> load;  ///< F_alpha, the Dirichlet data moved to the right
  Teuchos::RCP<const algebra::Vector> pairing;        ///< D
  std::array<double, 2> tension = {1, 1};             ///< mean diagonal of S_alpha: a few mu_alpha
  std::array<double, 2> theta = {0.5, 0.5};           ///< theta_alpha = tension_alpha / (tension_1 + tension_2)

  bool shared() const { return matrix[0] == matrix[1]; }
  algebra::MapPtr map() const { return pairing->getMap(); }
};

/// X = (u1, u2, lambda) interlaced by node <-> three columns.
void split(const algebra::Vector& X, algebra::MultiVector& fields);
void join(const algebra::MultiVector& fields, algebra::Vector& X);

}  // namespace thixis::models
