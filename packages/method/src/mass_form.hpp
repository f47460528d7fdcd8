#pragma once
#include "thixis/method/space.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

/// factor a_K(u, v) + weight (u, v)_K; the mass is that of the cells' polynomials, the first unknowns of each cell.
class MassForm final : public CellForm {
 public:
  /// `cells`: the patch cells. `form` null: no a_K. The mesh must outlive it.
  MassForm(const mesh::Mesh& mesh, const mesh::View<const LocalIndex*>& cells, const reference::CellBasis& basis,
           std::shared_ptr<const CellForm> form, double factor, double weight);
  void matrices(LocalIndex first, const LocalMatrices& A) const override;

 private:
  const mesh::Mesh& mesh_;
  mesh::View<const LocalIndex*> cells_;
  Kokkos::View<const double**, Kokkos::LayoutRight> M_;  ///< (psi_i, psi_j) on the reference triangle
  std::shared_ptr<const CellForm> form_;
  double factor_, weight_;
};

}  // namespace thixis::method
