#pragma once
#include <memory>
#include <string>
#include <vector>

#include "estimate/flux_terms.hpp"
#include "flux/discretization_flux.hpp"
#include "multiplier/multiplier_fit.hpp"
#include "thixis/bound/feasible.hpp"
#include "thixis/bound/guaranteed_bound.hpp"

namespace thixis::bound {

/// What a cell may add to the square of the bound without being looked at more closely, relative to the mean flux term of cells: no more
/// than a hundredth of the whole in eta_disc, and 1e-4 of its square in the bound.
constexpr double negligible = 1e-4;

/// What bounds of stationary problems and of steps in time are made of on a mesh: fluxes, a multiplier, a feasible pair.
struct BoundParts {
  const method::Space& space;
  ContactProblem problem;
  const int q;  ///< of the fluxes
  const std::vector<bool> held;
  std::shared_ptr<const FeasiblePair> feasible;
  const Metrics metric;  ///< of the patch cells
  const CellShares shares;
  const ResidualLift lift;
  const DiscretizationFlux discretization;
  MembraneFlux membrane[2];
  MultiplierFit multiplier;
  FeasiblePair::Parts pair;          ///< of the last iterate
  View<double*> contact_lin;         ///< (owned cell): sum_l M_l max(K_l, 0), shared out
  GuaranteedBound::CellParts cells;  ///< of the last iterate
  std::vector<std::string> doubts;   ///< what keeps the bound from being guaranteed, but for time

  /// Collective.
  BoundParts(const method::Space& of, const ContactProblem& contact, const mesh::Hierarchy& hierarchy, int level);
  BoundParts(const BoundParts&) = delete;
  BoundParts& operator=(const BoundParts&) = delete;

  const core::Comm& comm() const { return space.mesh().comm; }
  LocalIndex owned() const { return space.mesh().owned_cells; }

  /// Forces and tractions at a time, with the interface where it is then. Collective.
  void set_sources(double time);
  /// sigma_disc of a membrane. `rate`: of DiscretizationFlux. Collective.
  void balance(const Iterate& iterate, int alpha, const ConstCellTable& rate) const;
  /// The mean over all cells of sum_alpha |mu^{1/2} grad u_h + mu^{-1/2} sigma_alpha|²_K. Collective.
  double mean_flux_term() const;
  /// Sets the squares of the cells' parts to 0, and where FluxTerms adds to them.
  FluxTerms::Cells empty_cells() const;
  /// f - (-1)^alpha lambda, densities on the owned cells, lambda what the fluxes are in equilibrium with.
  CellTable balanced_density(int alpha) const;

  std::size_t bytes() const;
};

/// Sets the worst relations of the parts of cells (method::worst_cells). Collective.
void find_worst_cells(const GuaranteedBound::CellParts& cells, const mesh::Mesh& mesh, complementarity::Estimate& eta);

}  // namespace thixis::bound
