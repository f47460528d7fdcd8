#pragma once
#include <memory>
#include <vector>

#include "thixis/algebra/solver.hpp"
#include "thixis/equilibration/cell_fields.hpp"

namespace thixis::equilibration {

/// (grad rho, grad psi_a) = (r, psi_a) for the hat functions of all free vertices of a whole mesh, rho of their span: P_1 by the form and
/// the assembly of `method`.
class RootPoisson {
 public:
  /// `held`: per boundary tag; `at_rest`: vertices that are held besides. The mesh must outlive it.
  RootPoisson(const mesh::Mesh& mesh, const std::vector<bool>& held, const std::vector<LocalIndex>& at_rest, int q);
  ~RootPoisson();
  /// r: (cell, dim P_q); overwrites rho (cell, i), its values at the vertices of the cells.
  void solve(const ConstCellTable& r, const Kokkos::View<double* [3], Kokkos::LayoutRight>& rho) const;
  std::size_t bytes() const { return sizeof(double) * moments_.size(); }

 private:
  const mesh::Mesh& mesh_;
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> row_;  ///< (cell, i) -> row; -1: held
  Matrix first_row_;
  CellTable moments_;
  algebra::MapPtr map_;
  std::unique_ptr<algebra::Solver> solver_;  ///< none where every vertex is held
};

}  // namespace thixis::equilibration
