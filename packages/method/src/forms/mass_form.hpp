#pragma once
#include "thixis/method/form.hpp"

namespace thixis::method {

/// factor a_K(u, v) + weight (u, v)_K; the mass is that of the cells' polynomials, the first unknowns of each cell.
class MassForm final : public ElementForm {
 public:
  /// `form` null: no a_K. The space must outlive it.
  MassForm(const Space& space, std::shared_ptr<const ElementForm> form, double factor, double weight);
  void matrices(LocalIndex first, const LocalMatrices& A) const override;

 private:
  const Space& space_;
  Kokkos::View<const double**, Kokkos::LayoutRight> M_;  ///< (psi_i, psi_j) on the reference triangle
  std::shared_ptr<const ElementForm> form_;
  double factor_, weight_;
};

}  // namespace thixis::method
