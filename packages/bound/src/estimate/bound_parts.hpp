#pragma once
#include "data/on_host.hpp"
#include "data/sources.hpp"
#include "flux/flux_sources.hpp"
#include "flux/stress.hpp"
#include "multiplier/multiplier.hpp"
#include "thixis/bound/feasible.hpp"
#include "thixis/bound/guaranteed_bound.hpp"
#include "thixis/equilibration/multilevel_flux.hpp"
#include "thixis/equilibration/patch_flux.hpp"

namespace thixis::bound {

/// What a cell may add to the square of the bound without being looked at more closely, relative to the mean flux term of cells: no more
/// than a hundredth of the whole in eta_disc, and 1e-4 of its square in the bound.
constexpr double negligible = 1e-4;

/// What bounds of stationary problems and of steps in time are made of: fluxes, multiplier and feasible pair on a mesh.
struct BoundParts {
  /// What belongs to one membrane.
  struct Membrane {
    std::vector<double> least_tension;
    Sources data;
    std::unique_ptr<Stress> stress;
    CellTable w, r_alg, r_lin, sigma_disc, sigma_alg, sigma_lin;
    bool has_alg = false, has_lin = false;  ///< else r and sigma are 0
    Stress::Norms norms;
  };

  const method::PolynomialSpace& space;
  ContactProblem problem;
  const mesh::Mesh& mesh;
  core::Comm comm;
  int q, n, flux;
  LocalIndex owned, patch_cells;
  std::vector<bool> held;
  equilibration::MultilevelFlux lift;
  std::shared_ptr<const FeasiblePair> feasible;
  std::unique_ptr<NonNegativeMultiplier> multiplier;
  std::unique_ptr<equilibration::PatchFlux> patches;  ///< of conforming spaces
  Membrane membrane[2];
  Matrix from_moments;
  Kokkos::View<const double***, Kokkos::LayoutRight> times;
  Metrics metric;
  CellTable moments, lambda, positive, patch_lambda, patch_density, patch_target;
  View<double*> h, contact_lin, multiplier_rest;
  bool has_positive = false;
  FeasiblePair::Parts parts;
  GuaranteedBound::CellParts cells;
  std::vector<std::string> doubts;  ///< what keeps the bound from being guaranteed, but for time
  bool gap_at_points = false;       ///< FeasiblePair::Parts::at_points of the last iterate, on any rank

  BoundParts(const method::PolynomialSpace& of, const ContactProblem& contact, const mesh::Hierarchy& hierarchy, int level);

  /// Forces and tractions at a time, with the interface where it is then. Collective.
  void set_sources(double time);

  /// lambda^ of an iterate; `above`, `cut_off`: D_l max(X3_l, 0) on points(), -D_l min(X3_l, 0) on map(), overwritten.
  void fit_multiplier(const Iterate& iterate, algebra::Vector& above, algebra::Vector& cut_off);

  /// R as a polynomial in every patch cell. `has`: whether r is not 0, in and out.
  void represent(const algebra::Vector& R, const CellTable& r, bool& has) const;
  /// The residual, its representative and its lift; returns what the lift leaves (MultilevelFlux).
  double lift_residual(const algebra::Vector& R, const CellTable& r, const CellTable& sigma, bool& has) const;
  /// `rate`: a polynomial source to be taken from the force, densities on the patch cells; of length 0: none.
  void discretization_flux(const Iterate& iterate, int alpha, const ConstCellTable& rate) const;
  /// The fluxes of a membrane.
  Stress::Fluxes fluxes(int alpha) const;
  /// The norms of w plus the fluxes of a membrane; u: what w was made from.
  void measure(const method::Coefficients& u, int alpha) const;

  /// The mean over all cells of sum_alpha |mu^{1/2} grad u_h + mu^{-1/2} sigma_alpha|²_K. Collective.
  double mean_flux_term() const;
  /// sum_l M_l max(K_l, 0), shared out to the cells.
  void contact_at_points(const algebra::Vector& above, const algebra::Vector& gap);
  /// Cells where the solution is exact have no discretization error to compare with: a thousandth of the mean one stands in for it.
  void find_worst_cells(complementarity::Estimate& eta) const;

  std::size_t bytes() const;

 private:
  void extend(const algebra::Vector& at_points, algebra::Vector& all) const;
  void split_multiplier(const algebra::Vector& X3, algebra::Vector& above, algebra::Vector& below) const;
  void compare_multipliers(const algebra::Vector& above);
};

bool vanishes(const algebra::Vector& v);

}  // namespace thixis::bound
