#pragma once
#include <memory>
#include <vector>

#include "thixis/algebra/fwd.hpp"
#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// A multiplier that is nowhere negative, from moments M_l >= 0 against the basis functions (docs/methods/estimates.md, 5).
class NonNegativeMultiplier {
 public:
  virtual ~NonNegativeMultiplier() = default;
  /// moments: M_l = max(X3_l, 0) D_l at contact points. density: of the multiplier on the owned cells, (K, dim P_q); patch: for conforming
  /// spaces (k, i dim P_q + m), the part of it that belongs to vertex i of patch cell k, empty for others. Overwrites both. Collective.
  virtual void operator()(const algebra::Vector& moments, const CellTable& density, const CellTable& patch) const = 0;
  /// What the last call took for the moments against held functions, (patch cell, l); of length 0: there are none to be had.
  virtual ConstCellTable held_moments() const { return {}; }
  virtual std::size_t bytes() const = 0;
};

/// Conforming spaces: on the patch of every vertex a the polynomial of degree p - 1 that fits the moments best, made to have the moment of
/// the hat function psi_a that they give, and drawn to its mean just so far that it is nowhere negative (by its Bernstein coefficients);
///
///     lambda = sum_a psi_a L_a >= 0,   (L_a, psi_a) = sum_l c_l M_l  with psi_a = sum_l c_l psi_l   at every free vertex.
///
/// `avoid`, by patch cell (of length 0: none): cells in which the obstacle jumps. Patches that have others with contact leave them without
/// a multiplier, which would press there on a gap that the feasible function can not close.
std::unique_ptr<NonNegativeMultiplier> patchwise_multiplier(const method::Space& space, const View<const bool*>& avoid);

/// Functions without continuity: in every cell the function with these moments (against held functions those of HeldMoments), projected on
/// P_q and drawn to its mean likewise.
std::unique_ptr<NonNegativeMultiplier> cellwise_multiplier(const method::Space& space);

}  // namespace thixis::bound
