#pragma once
#include <array>
#include <memory>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/contact/system.hpp"
#include "thixis/membranes/scene.hpp"
#include "thixis/method/method.hpp"

namespace thixis::membranes {

/// m = 1 or 2 membranes on one space, whose first unknowns on each rank are the contact points:
///
///     S = diag(S_1, …, S_m),     K = u_1 - u_2, or u_1 - psi for m = 1.
///
/// Where all tensions are constant, S_alpha = mu_alpha matrix_1 with the matrix of the unit tension.
struct MembraneOperator {
  contact::System system;                        ///< its loads with the Dirichlet data moved to the right
  Teuchos::RCP<const algebra::Vector> obstacle;  ///< psi_l, on map(); null for m = 2
  std::array<double, 2> theta = {0, 1};          ///< m = 2: bound::Shares::of_mean, by the mean diagonals of S_alpha, without mass

  int count() const { return system.fields(); }
  algebra::MapPtr map() const { return system.map(); }               ///< of each u_alpha
  const algebra::MapPtr& points() const { return system.points(); }  ///< of lambda
  int matrix_of(int alpha) const { return system.S.matrix.size() == 1 ? 0 : alpha; }
  double factor(int alpha) const { return system.S.weight[matrix_of(alpha)](alpha, alpha); }
  /// y <- c S_alpha u + d y.
  void apply(int alpha, const algebra::Vector& u, algebra::Vector& y, double c = 1, double d = 0) const;
  /// F_alpha.
  Teuchos::RCP<const algebra::Vector> load(int alpha) const { return system.load->getVector(alpha); }
};

/// The operator of a scene, from the forms of the membranes on their space. `lift`, `body`: Dirichlet data and loads of each membrane.
/// Collective.
MembraneOperator membrane_operator(const MembraneScene& scene, const method::Method& by, const std::array<method::FormPtr, 2>& form,
                                   const method::Coefficients* lift, const Teuchos::RCP<algebra::Vector>* body);

/// The matrices of a scene in time, S_alpha + weight M with the mass M of the space; symbolic work is done once.
class Inertia {
 public:
  /// Takes over the stiffness of `membranes`, whose matrices it replaces: by one where both membranes have the same stiffness. Collective.
  Inertia(const method::Space& space, MembraneOperator& membranes);
  /// New values in the matrices of `membranes`, and new cell forms.
  void set(double weight, MembraneOperator& membranes);

 private:
  const method::Space& space_;
  std::vector<double> factor_;  ///< of each of the different matrices
  std::vector<Teuchos::RCP<const algebra::Matrix>> stiffness_;
  std::vector<std::shared_ptr<const method::ElementForm>> form_;
  algebra::MatrixPtr mass_;
  std::vector<algebra::MatrixPtr> sum_;
};

/// Columns of X, without a copy as long as X is there; residuals and increments likewise.
struct Fields {
  Fields(const MembraneOperator& membranes, algebra::Vector& X);
  Fields(const MembraneOperator& membranes, const algebra::Vector& X);  ///< to be read only

  algebra::MultiVector u;  ///< a column for each membrane, on map()
  algebra::Vector lambda;  ///< on points(); of residuals: C
};

/// u - v.
method::Coefficients difference(const method::Coefficients& u, const method::Coefficients& v);
/// K = u_1 - u_2 or u_1 - psi, on points().
void gap(const MembraneOperator& membranes, const algebra::MultiVector& u, algebra::Vector& K);

}  // namespace thixis::membranes
