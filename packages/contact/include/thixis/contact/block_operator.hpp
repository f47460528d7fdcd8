#pragma once
#include <memory>
#include <vector>

#include "thixis/algebra/fwd.hpp"
#include "thixis/contact/small.hpp"
#include "thixis/method/form.hpp"

namespace thixis::contact {

/// The operator as sums over the cells, matrix_k = sum of form[k]: for static condensation.
struct CellForms {
  method::ElementUnknowns elements;  ///< columns of the matrices; the first `interior` of each cell belong to it alone
  int interior = 0;
  bool symmetric = true;
  std::vector<std::shared_ptr<const method::ElementForm>> form;
};

/// m fields u_1, …, u_m, each with N unknowns on one map, and
///
///     S = (S_ij),     S_ij = sum_k weight_k(i, j) matrix_k,     all matrices on one graph:
///
/// fields that share an operator are one matrix; fields that do not act on each other have diagonal weights.
struct BlockOperator {
  int fields = 1;
  std::vector<Teuchos::RCP<const algebra::Matrix>> matrix;
  std::vector<Small> weight;
  std::shared_ptr<const CellForms> cells;  ///< null: nothing is to be condensed

  algebra::MapPtr map() const;
  /// No field acts on another.
  bool diagonal() const;
  /// y <- S u. `product`: room for one column a field. Each matrix is read once.
  void apply(const algebra::MultiVector& u, algebra::MultiVector& y, algebra::MultiVector& product) const;
  /// S_ii,ll, a column for each field.
  void diagonals(algebra::MultiVector& d) const;
};

}  // namespace thixis::contact
