#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "thixis/algebra/fwd.hpp"

namespace thixis::complementarity {

/// What the contact conditions are judged by: recomputed from the solution, cell by cell, without the matrices and residuals of the
/// solver. The vectors live on one map, one entry per contact point l. A multiplier is best given as the force at its point, not as force
/// per area: where the areas of points differ by orders, an error of the force in a tiny one is no error of the solution.
struct KktData {
  Teuchos::RCP<const algebra::Vector> gap;  ///< g_l
  /// λ_α,l from the equilibrium of each body α alone, e.g. -(f1, ψ_l) + μ1 (∇u1, ∇ψ_l) and (f2, ψ_l) - μ2 (∇u2, ∇ψ_l): the sign that makes
  /// each of them >= 0.
  std::vector<Teuchos::RCP<const algebra::Vector>> equilibrium;
  Teuchos::RCP<const algebra::Vector> claimed;  ///< the multiplier in X, in the same units as λ_α
  std::vector<double> body_scale;               ///< > 0: the size of a force that matters to each body; empty: multiplier_scale
  double unbalanced = 0;        ///< worst |residual| of the equations without a contact point, in units of what matters to the body
  double between_nodes = 0;     ///< worst violation max(-g, 0) between the points
  double gap_scale = 1;         ///< > 0: the size of a gap that matters, e.g. max |u|
  double multiplier_scale = 1;  ///< > 0: the size of a multiplier that matters, e.g. max |F_l|
  double of_residual = 1;       ///< what a residual 1, at one point and in the norm of the problem, makes of a relative violation

  /// What a residual r allows at one point, r of_residual, but at least 1e-6 and at most 1e-3: no tolerance of a solver makes a wrong
  /// answer right.
  double allowed(double r) const { return std::min(std::max(1e-6, r * of_residual), 1e-3); }
};

/// How far data are from g >= 0, λ >= 0, g λ = 0, λ in equilibrium with every body: relative, >= 0, maxima over all ranks; infinite where
/// data are not finite.
struct Kkt {
  double infeasible = 0;     ///< max_l max(-g_l, 0) / gap_scale
  double negative = 0;       ///< max_l,α max(-λ_α,l, 0) / scale_α, and over the claimed multiplier / multiplier_scale, too
  double complementary = 0;  ///< max_l,α min(|g_l| / gap_scale, |λ_α,l| / scale_α), over the claimed multiplier, too
  double between_nodes = 0;  ///< violation between the points / gap_scale; a discretization error for degree >= 2, not judged by `holds`
  double equilibrium = 0;    ///< max_l,α |λ_α,l - claimed_l| / scale_α, and unbalanced

  double worst() const;  ///< of all but between_nodes
  bool holds(double tolerance) const { return worst() <= tolerance; }
  /// "The contact conditions hold up to 3.1e-11." or "... are violated: multiplier 2.0e-03 below zero, ...", naming what exceeds it.
  std::string sentence(double tolerance) const;
};

/// Collective. The minimum and not the product g λ measures complementarity: two arguments of size √tolerance are no complementary pair.
/// Throws core::Error if the vectors have different maps or a scale is not a positive number.
Kkt verify(const KktData& data);

}  // namespace thixis::complementarity
