#pragma once
#include <array>
#include <memory>
#include <optional>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/method/space.hpp"
#include "thixis/scene/membranes.hpp"

namespace thixis::models {

/// The stiffness as sums over the cells, S_alpha = factor_alpha · sum of form[alpha]: for static condensation.
struct CellForms {
  method::ElementUnknowns elements;  ///< columns of the matrices; the first `interior` of each cell belong to it alone
  int interior = 0;
  bool symmetric = true;
  std::array<std::shared_ptr<const method::CellForm>, 2> form;
};

/// The linear part of a problem with m = 1 or 2 membranes, on one space with N unknowns, the first P on each rank being contact points:
///
///     E_alpha(X) - F_alpha = S_alpha u_alpha - sigma_alpha D lambda - F_alpha,     S_alpha = factor_alpha · matrix_alpha,   sigma = (1,
///     -1), K = u_1 - u_2, or u_1 - psi for m = 1.
///
/// Where both tensions are constant, both matrices are one, that of the unit tension.
struct MembraneOperator {
  int count = 2;  ///< m
  std::array<Teuchos::RCP<const algebra::Matrix>, 2> matrix;
  std::array<double, 2> factor = {1, 1};
  std::array<Teuchos::RCP<algebra::Vector>, 2> load;  ///< F_alpha, the Dirichlet data moved to the right
  Teuchos::RCP<const algebra::Vector> pairing;        ///< D, on points()
  Teuchos::RCP<const algebra::Vector> obstacle;       ///< psi_l, on map(); null for m = 2
  std::array<double, 2> tension = {1, 1};             ///< mean diagonal of S_alpha: a few mu_alpha
  std::array<double, 2> theta = {0.5, 0.5};           ///< theta_alpha = tension_alpha / (tension_1 + tension_2);  m = 1: (0, 1)
  std::optional<CellForms> condensed;                 ///< what belongs to one cell alone is eliminated

  bool shared() const { return count == 1 || matrix[0] == matrix[1]; }
  algebra::MapPtr map() const { return matrix[0]->getRowMap(); }  ///< of each u_alpha
  algebra::MapPtr points() const { return pairing->getMap(); }    ///< of lambda
  algebra::MapPtr interlaced() const;                             ///< of X, in the order of Layout
};

/// The operator of a scene. `lift`, `body`: Dirichlet data and loads of each membrane. Collective.
MembraneOperator membrane_operator(const scene::MembraneScene& scene, const method::Space& space, const method::MethodParams& method,
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
  int count_;  ///< of different matrices
  std::array<double, 2> factor_;
  std::array<Teuchos::RCP<const algebra::Matrix>, 2> stiffness_;
  std::array<std::shared_ptr<const method::CellForm>, 2> form_;
  algebra::MatrixPtr mass_, sum_[2];
};

/// Where the fields of a node stand in X on a rank: u_1, …, u_m, and lambda behind them if it is a contact point, l < points.
struct Layout {
  int membranes;
  LocalIndex points;
  KOKKOS_INLINE_FUNCTION LocalIndex operator()(LocalIndex l, int field) const { return membranes * l + (l < points ? l : points) + field; }
};
Layout layout(const MembraneOperator& membranes);

/// X taken apart; residuals and increments likewise.
struct Fields {
  explicit Fields(const MembraneOperator& membranes);
  Fields(const MembraneOperator& membranes, const algebra::Vector& X);

  algebra::MultiVector u;  ///< a column for each membrane, on map()
  algebra::Vector lambda;  ///< on points(); of residuals: C
};
void split(const algebra::Vector& X, Fields& fields);
void join(const Fields& fields, algebra::Vector& X);

/// Fields that every node has, interlaced <-> columns.
void split(const algebra::Vector& x, algebra::MultiVector& columns);
void join(const algebra::MultiVector& columns, algebra::Vector& x);

/// u - v.
method::Coefficients difference(const method::Coefficients& u, const method::Coefficients& v);
/// K = u_1 - u_2 or u_1 - psi, on points().
void gap(const MembraneOperator& membranes, const algebra::MultiVector& u, algebra::Vector& K);

}  // namespace thixis::models
