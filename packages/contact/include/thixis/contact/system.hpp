#pragma once
#include <Kokkos_Core.hpp>

#include "thixis/contact/block_operator.hpp"
#include "thixis/contact/frame.hpp"

namespace thixis::contact {

/// Contact points p lie at nodes, and each of them constrains `gaps` combinations of the fields there:
///
///     K_pg = k0_pg + sum_i B(i, g) u_i(node(p)) >= 0,    G_pg = lambda_pg >= 0,    K G = 0.
///
/// Nodes without a point carry the frame, too, but nothing constrains them. At most one point lies at a node.
struct Constraint {
  int gaps = 1;
  algebra::MapPtr points;                           ///< one id for each
  Kokkos::View<const LocalIndex*> node;             ///< (point) -> row of its node
  Frames frames;                                    ///< B is what makes them: K - k0 = the last coordinates of the node
  Teuchos::RCP<const algebra::MultiVector> offset;  ///< k0, on points, a column for each gap; null: 0
  Teuchos::RCP<const algebra::Vector> pairing;      ///< D_p > 0, on points: D_p lambda_pg is the force through the gap
};

/// What is linear in a contact problem:
///
///     E_i(X) - F_i = sum_j S_ij u_j - sum_g B(i, g) D lambda_g - F_i,     K = k0 + Bᵀ u.
///
/// **X in columns**: u_1, …, u_m, each in the order of the map of the fields, then lambda_1, …, lambda_q in that of the points; so it is on
/// each rank.
struct System {
  BlockOperator S;
  Constraint constraint;
  Teuchos::RCP<algebra::MultiVector> load;  ///< F, a column for each field; may be overwritten

  int fields() const { return S.fields; }
  int gaps() const { return constraint.gaps; }
  algebra::MapPtr map() const { return S.map(); }                      ///< of each u_i
  const algebra::MapPtr& points() const { return constraint.points; }  ///< of each lambda_g
};

/// The map of X. Its ids mean nothing. Collective.
algebra::MapPtr map_of_all(const System& system);
/// The map of K and G: gaps · points values, in columns. Collective.
algebra::MapPtr map_of_gaps(const System& system);

/// Columns of X without a copy, valid as long as X is: the fields, and the multipliers.
algebra::MultiVector fields(const System& system, const algebra::Vector& X);
algebra::MultiVector multipliers(const System& system, const algebra::Vector& X);
algebra::MultiVector fields_nonconst(const System& system, algebra::Vector& X);
algebra::MultiVector multipliers_nonconst(const System& system, algebra::Vector& X);
/// K or G, likewise: a column for each gap.
algebra::MultiVector gaps(const System& system, const algebra::Vector& K);
algebra::MultiVector gaps_nonconst(const System& system, algebra::Vector& K);

/// K = k0 + Bᵀ u, a column for each gap.
void gap(const System& system, const algebra::MultiVector& u, algebra::MultiVector& K);
/// y <- y - B D lambda.
void subtract_pressure(const System& system, const algebra::MultiVector& lambda, algebra::MultiVector& y);

}  // namespace thixis::contact
