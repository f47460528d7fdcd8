#pragma once
#include <Kokkos_Core.hpp>

#include "thixis/mesh/mesh.hpp"
#include "thixis/reference/modal.hpp"

/// Functions and fluxes given cell by cell, in modal coefficients of the reference triangle (reference::Modal): densities (cell, dim P_q),
/// fluxes (cell, 2 dim P_{q+1}).
namespace thixis::equilibration {

using mesh::View;
using CellTable = Kokkos::View<double**, Kokkos::LayoutRight>;
using ConstCellTable = Kokkos::View<const double**, Kokkos::LayoutRight>;
using Matrix = Kokkos::View<const double**, Kokkos::LayoutRight>;

/// The map from the reference triangle to a cell, as fluxes see it: ∫_K v·w = sum_ij G_ij ∫ v̂_i ŵ_j, G = DF^T DF / det, det = 2|K|.
struct Metric {
  double det, G00, G01, G11;

  /// |v|²_K of n modal coefficients of each component.
  KOKKOS_INLINE_FUNCTION double square(const double* v0, const double* v1, int n) const {
    double s00 = 0, s01 = 0, s11 = 0;
    for (int k = 0; k < n; ++k) {
      s00 += v0[k] * v0[k];
      s01 += v0[k] * v1[k];
      s11 += v1[k] * v1[k];
    }
    return G00 * s00 + 2 * G01 * s01 + G11 * s11;
  }
};
using Metrics = View<const Metric*>;

/// Of the cells listed.
Metrics metrics(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells);

}  // namespace thixis::equilibration
