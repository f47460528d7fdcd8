#pragma once
#include <memory>

#include "thixis/algebra/solver.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/method/polynomial_space.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::fem {

/// The mass matrix M_lm = (psi_l, psi_m) of **all** nodes, boundary included: it turns moments into the function lambda_h of the space that
/// has them, lambda_h = sum_l X3_l Theta_l with (Theta_l, psi_m) = delta_lm.
class Mass {
 public:
  /// Collective. `cells`: the patch cells with their entries.
  Mass(const mesh::Mesh& mesh, const mesh::View<const LocalIndex*>& cells, const reference::CellBasis& basis,
       const method::Structure& structure);
  ~Mass();
  /// Coefficients of lambda_h at all entries, ghosts included, from the moments at the entries of this rank. Collective.
  method::Coefficients solve(const std::vector<double>& moments) const;

 private:
  core::Comm comm_;
  std::vector<LocalIndex> entry_of_column_;
  algebra::MatrixPtr M_;
  std::unique_ptr<algebra::Solver> solver_;
};

}  // namespace thixis::fem
