#pragma once
#include "thixis/algebra/structure.hpp"

namespace thixis::algebra {

/// A coarser grid: its functions are u = P u_c on the finer one.
class Interpolation {
 public:
  explicit Interpolation(const Teuchos::RCP<const Matrix>& P);
  const Matrix& P() const { return *P_; }
  /// Pᵀ of the rows of this rank: its rows are the columns of P.
  const Matrix& transpose() const { return *transpose_; }
  void restrict_to_coarse(const Vector& r, Vector& coarse_r) const { transpose_->apply(r, coarse_r); }
  void add(const Vector& coarse_x, Vector& x) const { P_->apply(coarse_x, x, Teuchos::NO_TRANS, 1, 1); }

 private:
  Teuchos::RCP<const Matrix> P_, transpose_;
};

/// Pᵀ T A T P, T = 1 at coupled rows of A, 0 at the others: coarse functions are truncated where contact, or a condition, decides. What is
/// left of some may be nothing; their rows get 1 on the diagonal. R. Kornhuber (1994), doi:10.1007/s002110050077.
class Galerkin {
 public:
  /// All symbolic work. Collective.
  Galerkin(const Teuchos::RCP<const Matrix>& A, const Interpolation& interpolation);
  /// `coupled`: T, on the rows. Collective.
  void set_matrix(const Matrix& A, const Vector& coupled);
  /// The same object before and after each set_matrix.
  const MatrixPtr& product() const { return product_; }

 private:
  void take_from_other_ranks();

  const Interpolation& interpolation_;
  Teuchos::RCP<const Matrix> P_;  ///< its rows at all columns of A
  /// Products of the rows of this rank; those that lie on other ranks, the last ones, are sent there. On one rank they are the product.
  RowMap row_map_;
  Entries entries_;
  Values values_;
  MatrixPtr product_;
  Kokkos::View<const std::size_t*> place_;  ///< of the entries that stay here, in the product
  MatrixPtr sent_;
  Teuchos::RCP<const Tpetra::Export<LocalIndex, GlobalIndex, Node>> send_;
  Teuchos::RCP<Vector> coupled_;  ///< with those of other ranks
};

}  // namespace thixis::algebra
