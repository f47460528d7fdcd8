#pragma once
#include <memory>

#include "flux/discretization_flux.hpp"
#include "multiplier/multiplier.hpp"

namespace thixis::bound {

/// lambda^ >= 0 of an iterate, and how far it is from the multiplier that the fluxes are in equilibrium with.
class MultiplierFit {
 public:
  /// `avoid`: of patchwise_multiplier. The space and the shares must outlive it. Collective.
  MultiplierFit(const method::Space& space, int q, const View<const bool*>& avoid, const CellShares& shares, const Metrics& metric);

  /// From X3: lambda^, and what is cut off. `above`, `cut_off`: D_l max(X3_l, 0) on points(), -D_l min(X3_l, 0) on map(), overwritten.
  /// Collective.
  void operator()(const algebra::Vector& X3, algebra::Vector& above, algebra::Vector& cut_off);

  const CellTable& density() const { return lambda_; }  ///< (owned cell, dim P_q): of lambda^
  FluxMultiplier for_flux() const { return {of_vertices_, fit_->held_moments()}; }
  /// (owned cell, dim P_q): the multiplier that the fluxes are in equilibrium with: lambda^ itself, or Pi_q lambda_h^+, lambda_h^+ the
  /// function with the moments D max(X3, 0).
  ConstCellTable balanced() const { return conforming_ ? lambda_ : positive_; }
  /// |lambda^ - Pi_q lambda_h^+|_K; of length 0 where the fluxes balance lambda^.
  const View<double*>& rest() const { return rest_; }
  std::size_t bytes() const;

 private:
  void split(const algebra::Vector& X3, algebra::Vector& above, algebra::Vector& below) const;
  void compare(const algebra::Vector& above);

  const method::Space& space_;
  const CellShares& shares_;
  Metrics metric_;
  bool conforming_;
  std::unique_ptr<NonNegativeMultiplier> fit_;
  CellTable lambda_, of_vertices_, positive_;
  View<double*> rest_;
};

/// sum_l M_l max(K_l, 0), M_l = `above`, shared out to the owned cells; overwrites `out`. Collective.
void contact_at_points(const method::Space& space, const CellShares& shares, const algebra::Vector& above, const algebra::Vector& gap,
                       const View<double*>& out);

}  // namespace thixis::bound
