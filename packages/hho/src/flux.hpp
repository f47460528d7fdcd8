#pragma once
#include "faces.hpp"
#include "reference_cell.hpp"
#include "thixis/method/flux_density.hpp"
#include "thixis/method/space.hpp"

namespace thixis::hho {

using Table = Kokkos::View<const double**, Kokkos::LayoutRight>;
using method::ElementEntries;

/// What the flux of HHO needs of the reference cell, q = p-1.
struct FluxTables {
  Table differences;   ///< (dim P_q + dim P_q + 3p, unknown): modal coefficients of both components of DF^T G_K v, then R_f v
  Table trace;         ///< (f p + j, k): ∫ of phi_k L_j over face f, k < dim P_q
  Table from_moments;  ///< (2 dim P_{q+1}, 3p + 2 dim P_{q-1})
};
FluxTables flux_tables(const ReferenceCell& reference);

/// The faces of the patch cells, (k, f): inside, with Dirichlet data, or with a traction, then the row of `traction` that gives it.
constexpr LocalIndex face_inside = -1, face_held = -2;
struct FaceData {
  View<const LocalIndex* [3]> row;
  View<const LocalIndex* [3]> neighbour;  ///< patch cell across the face, -1 where there is none here
  Moments traction;                       ///< (row, j): ∫_F t L_j / |F|, L_j from the lower to the higher vertex id
};

/// The flux of HHO on the first `owned` cells (docs/methods/hho.md, 5). Phi_KF of both cells of a face is averaged:
///
///     Phi_KF = -P·n_K + kappa mu_K/h (Π_F u_K - u_F),     P = Π_{P_{p-1}(K)²} mu G_K u,
///     sigma·n_K = (Phi_KF - Phi_K'F)/2 inside, Phi_KF with Dirichlet data, -Π_F t with a traction;   (sigma, v)_K = -(P, v)_K, v in
///     P_{p-2}².
void native_flux(const mesh::Mesh& mesh, const ReferenceCell& reference, const FluxTables& tables, const method::MethodParams& params,
                 const method::FluxDensity& density, const FaceData& faces, const ElementEntries& entries, const method::Coefficients& u,
                 LocalIndex owned, const View<double**>& sigma);

/// moments(k, l) = R_K(psi_l) + sum_F w_F R_F(Π_F psi_l), w_F = 1/2 inside, 1 on the boundary.
void share(const mesh::Mesh& mesh, const ReferenceCell& reference, const method::MethodParams& params, const View<const LocalIndex*>& cells,
           const ElementEntries& entries, const method::Coefficients& R, const View<double**>& moments);

}  // namespace thixis::hho
