#pragma once
#include <Kokkos_Core.hpp>
#include <Teuchos_SerialDenseMatrix.hpp>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

/// The iterate of GMRES in the middle of a cycle, x + M^{-1} V y with R y = z: R the triangle of the Hessenberg matrix, z its right-hand
/// side. Its vectors are made at the first one and kept: only who looks at iterates pays for them, and only once.
class KrylovIterate {
 public:
  using Dense = Teuchos::SerialDenseMatrix<int, double>;

  /// k: vectors of the basis V so far. inverse: M^{-1}, or null. Valid until the next call.
  Teuchos::RCP<const MultiVector> operator()(const MultiVector& x, const Operator* inverse, const MultiVector& V, const Dense& R,
                                             const Dense& z, int k);

 private:
  void solve_triangle(const Dense& R, const Dense& z, int k);

  Teuchos::RCP<Vector> combined_, formed_;
  Kokkos::View<double*> y_;
  Kokkos::View<double*>::HostMirror y_host_;
};

}  // namespace thixis::algebra
