#pragma once
#include <vector>

#include "data/cut_oscillation.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// What is known of the data of one membrane at one time, cell by cell.
struct Sources {
  CellTable force;                     ///< (patch cell, dim P_{q+1}): density of the projection of f
  View<double*> oscillation;           ///< (owned cell): h_K/pi mu^{-1/2} |f - Pi_q f|_K
  View<double*> sharp_oscillation;     ///< (owned cell): a smaller bound on the same (cut_oscillation.hpp)
  View<double*> traction_oscillation;  ///< (owned cell): what Neumann data leave (see below)
  CellTable traction;                  ///< for PatchFlux: Legendre moments of -psi_a t on Neumann faces; empty where there are none
};

/// The oscillation of Neumann data t on a face F of K enters by the trace inequality for functions without mean in K,
///
///     |v|²_F <= |F| h_K²/|K| (1 + pi)/pi² |grad v|²_K,
///
/// as (that constant)^{1/2} mu^{-1/2} |t - Pi_q t|_F. mu: its least value in the cell. `time`: of the data. `cut_cells`: null where nothing
/// asks for the sharp oscillation. Collective.
Sources sources(const method::Space& space, int q, const scene::Field& force, const method::BoundaryValues& boundary, double time,
                const CutOscillation* cut_cells, const std::vector<double>& least_tension);

/// Longest side of a cell, and of each owned cell.
double diameter(const mesh::HostMesh& mesh, LocalIndex K);
std::vector<double> diameters(const mesh::Mesh& mesh);

/// The tags with Dirichlet data.
std::vector<bool> held_tags(const method::BoundaryValues& boundary);

}  // namespace thixis::bound
