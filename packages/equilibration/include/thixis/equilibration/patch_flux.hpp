#pragma once
#include <memory>
#include <vector>

#include "thixis/equilibration/cell_fields.hpp"

namespace thixis::equilibration {

/// Equilibrated fluxes on the patches of vertices (docs/methods/estimates.md, 3). For every vertex a of an owned cell, on the cells around
/// it (the patch omega_a), the flux sigma_a of RT_q(omega_a) nearest to psi_a w, psi_a the hat function,
///
///     sigma_a = argmin |v - psi_a w|   over   div v = g_a  (projected on P_q),   v·n = 0 on the faces of the patch that do not contain a,
///                                             v·n = 0 on boundary faces that contain a and are not held, but for the data there,
///                                             v·n free on held (Dirichlet) ones;
///
/// and the sum of all sigma_a on the owned cells. A particular flux is built cell by cell around the vertex; what is left is a small
/// positive definite system for the stream function of a divergence-free field, factored once per mesh.
class PatchFlux {
 public:
  /// `cells`: the patch cells, owned ones first (method::patch_cells); `held`: per boundary tag. The mesh must outlive it.
  PatchFlux(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q);
  ~PatchFlux();
  PatchFlux(const PatchFlux&) = delete;
  PatchFlux& operator=(const PatchFlux&) = delete;

  /// What the patches are given, all in modal coefficients on the patch cells.
  struct Data {
    ConstCellTable density;  ///< (k, i dim P_q + m): density of g_a on cell k for its vertex i; sums to zero on patches without a free face
    ConstCellTable target;   ///< (k, [2][dim P_q]): w, of degree at most q
    ConstCellTable
        traction;  ///< may be empty: (local face, e (q+1) + j): Legendre moments of the outward normal flux sigma_a·n on a boundary
                   ///< face that is not held, for the patch of its end vertex e = 0, 1, along the face from end 0 to end 1
  };
  /// sigma(K, ·) = sum_a sigma_a on the owned cells; overwritten.
  void operator()(const Data& data, const CellTable& sigma) const;

  std::size_t bytes() const;  ///< held for the mesh

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::equilibration
