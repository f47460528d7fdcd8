#pragma once
#include <Kokkos_Core.hpp>
#include <functional>
#include <memory>

#include "thixis/algebra/fwd.hpp"
#include "thixis/method/graph.hpp"

namespace thixis::contact {

/// (first, A): fills all of A(e, i, j), e < A.extent(0), with the local matrices of the elements first + e. Must not communicate.
using FillLocalMatrices = std::function<void(LocalIndex first, const Kokkos::View<double***, Kokkos::LayoutRight>& A)>;

/// What the block A_II of every element is known to be.
enum class LocalForm {
  general,           ///< nonsingular; eliminated with row pivoting
  positive_definite  ///< and A symmetric: half the work and half the memory; only i <= j is read of the local matrices
};

/// Static condensation. A x = b is the sum of dense matrices of elements, and the first unknowns of an element, I, belong to it alone; B
/// are its others. With the partial factorization of each local matrix,
///
///     [ A_II A_IB ]   [ L_II   ] [ U_II U_IB ]
///     [ A_BI A_BB ] = [ L_BI 1 ] [      S    ],     S = A_BB - A_BI A_II^{-1} A_IB,
///
/// the unknowns that remain solve S x_B = b_B - A_BI A_II^{-1} b_I, assembled, and then x_I = A_II^{-1} (b_I - A_IB x_B).
///
/// The unknowns I of an element lie on one rank. An unknown -1 (Dirichlet) has no row and no column; that holds in I, too.
class Condensation {
 public:
  /// Collective. rows, columns: of all unknowns; the rows are the first columns. elements: those that touch a row of this rank, the
  /// unknowns I of each are its first `interior` ones. All symbolic work is done here.
  Condensation(const algebra::MapPtr& rows, const algebra::MapPtr& columns, const method::ElementUnknowns& elements, int interior,
               LocalForm form);
  ~Condensation();
  Condensation(const Condensation&) = delete;
  Condensation& operator=(const Condensation&) = delete;

  /// Of the unknowns that remain: contiguous ids over the ranks, in the order of the original rows.
  algebra::MapPtr rows() const;
  algebra::GraphPtr graph() const;
  /// (row that remains) -> original row.
  const Kokkos::View<const LocalIndex*>& original_row() const;
  /// (original column) -> column of graph(), -1 for unknowns that are eliminated.
  const Kokkos::View<const LocalIndex*>& condensed_column() const;

  /// Collective. Factors the local matrices and assembles S, in blocks of elements that fit into the cache. Throws core::Error on all ranks
  /// if A_II of some element is singular (or not positive definite, where it should be), and what `local` throws.
  void set_matrix(const FillLocalMatrices& local);
  /// S; the same object before and after each set_matrix.
  const algebra::MatrixPtr& matrix() const;

  /// b_condensed = b_B - A_BI A_II^{-1} b_I. Collective.
  void reduce(const algebra::Vector& b, algebra::Vector& b_condensed) const;
  /// x_B = x_condensed, x_I = A_II^{-1} (b_I - A_IB x_B). Collective.
  void recover(const algebra::Vector& b, const algebra::Vector& x_condensed, algebra::Vector& x) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::contact
