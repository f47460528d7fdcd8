#pragma once
#include <Kokkos_Core.hpp>
#include <vector>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

/// Sweeps of Gauss and Seidel over the rows of each rank, A = D + L + U in an order by colour, in which rows of one colour do not couple:
/// the same numbers on any number of threads. What rows of other ranks couple, A_o, is Jacobi's part: its moduli l_i = sum_j |A_o(i, j)|
/// strengthen the diagonal, so that a sweep reduces the error for every symmetric positive definite A.
/// A. H. Baker, R. D. Falgout, T. V. Kolev, U. M. Yang (2011), doi:10.1137/100798806.
class GaussSeidel {
 public:
  /// Colours the rows. The columns of A begin with the rows of this rank.
  explicit GaussSeidel(const GraphPtr& graph);
  void set_matrix(const Matrix& A);

  /// x <- (D + l + L)^{-1} b, r <- b - A x. Collective.
  void forward(const Vector& b, Vector& x, Vector& r) const;
  /// x <- x + (D + l + U)^{-1} (b - A x), the adjoint sweep. Collective.
  void backward(const Vector& b, Vector& x) const;

  /// A row of A without its diagonal: entries of rows that come before it, of those that come behind, of other ranks.
  struct Rows {
    Kokkos::View<const LocalIndex*> row;  ///< (position) -> row of A
    Kokkos::View<std::size_t*> begin;     ///< by position, as all others
    Kokkos::View<std::size_t*> behind, remote;
    Kokkos::View<LocalIndex*> column;
    Kokkos::View<double*> value;
    Kokkos::View<double*> diagonal, inverse;  ///< D, (D + l)^{-1}
  };

 private:
  template <class Kernel>
  void for_colours(const char* label, const Kernel& kernel, bool backward) const;
  void fetch(const Vector& x) const;

  GraphPtr graph_;
  std::vector<LocalIndex> colour_;            ///< begin of each colour among the positions, and the end
  Kokkos::View<const LocalIndex*> position_;  ///< of each row
  Rows rows_;
  Teuchos::RCP<Vector> ghosted_;  ///< on several ranks: x with the values of other ranks
};

}  // namespace thixis::algebra
