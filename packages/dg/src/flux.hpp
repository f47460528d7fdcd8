#pragma once
#include "face_data.hpp"
#include "thixis/method/flux_density.hpp"

namespace thixis::dg {

using Table = Kokkos::View<const double**, Kokkos::LayoutRight>;
using method::ElementEntries;

/// What the flux of dG needs of the reference cell, q = p.
struct FluxTables {
  Table gradient;      ///< (d dim P_{p-1} + k, i): modal coefficients of the derivatives of psi_i in xi and eta
  Table trace;         ///< (f p + j, k): ∫ of phi_k L_j over face f, k < dim P_{p-1}
  Table from_moments;  ///< (2 dim P_{p+1}, 3(p+1) + 2 dim P_{p-1})
};
FluxTables flux_tables(const reference::CellBasis& basis);

/// Moments against L_j on the faces of the mesh, on [0,1] from the lower to the higher vertex id; 0 where nothing has been added.
struct FaceMoments {
  Kokkos::View<double**, Kokkos::LayoutRight> flux;   ///< (F, j): ∫ sigma·n_F L_j, j <= p
  Kokkos::View<double***, Kokkos::LayoutRight> slip;  ///< (F, s, j): ∫ mu_s [u] L_j, j < p, mu_s the trace from K+ (0) or K- (1)
};
FaceMoments face_moments(const mesh::Mesh& mesh, int degree);

/// Of the faces first + e, e < count, that carry a form, overwritten:
///
///     sigma·n_F = - {mu grad u}·n + (eta p²/|F|) mu_F [u],
///
/// without what Dirichlet data take off [u]; `held`: where nodes are held, [u] = 0. `entries`: (face, i) as in face_matrices.
void add_face_fluxes(const mesh::Mesh& mesh, const Faces& faces, const Traces& traces, const Penalty& penalty, bool held, LocalIndex first,
                     LocalIndex count, const Tensions& mu, const ElementEntries& entries, const Kokkos::View<const double*>& u,
                     const FaceMoments& moments);

/// Adds what boundary data change of both: weak Dirichlet data g take g off [u], tractions t (`weak` null) make sigma·n = -t.
void add_boundary_fluxes(const mesh::Mesh& mesh, const BoundaryData& data, const Traces& traces, const Penalty* weak,
                         const FaceMoments& moments);

/// sigma on the first `owned` cells (docs/methods/dg.md, 4): the normal fluxes of its faces, and
///
///     (sigma, v)_K = -(mu grad u, v)_K + theta sum_F w_F ([u], mu v·n)_F        for v in P_{p-1}(K)²,
///
/// w_F = 1/2 inside, 1 on the boundary.
void native_flux(const mesh::Mesh& mesh, const FluxTables& tables, double theta, const method::FluxDensity& density,
                 const ElementEntries& entries, const Kokkos::View<const double*>& u, const FaceMoments& faces, LocalIndex owned,
                 const View<double**>& sigma);

}  // namespace thixis::dg
