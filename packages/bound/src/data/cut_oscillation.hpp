#pragma once
#include <vector>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// h_K/j bounds |v - mean v|_K / |grad v|_K on every triangle, j the first zero of the Bessel function J_1 (Laugesen, Siudeja, J.
/// Differential Equations 249, 2010, doi:10.1016/j.jde.2010.02.020); convex domains in general have pi.
constexpr double poincare = 1 / 3.831705970207512;

/// In cells that the interface cuts, data jump, and |f - Pi_q f| is not small. What enters the bound is its dual norm, sup (f - Pi_q f,
/// v)_K / |grad v|_K, and that is bounded by a flux on 64 children of the cell, without normal flux through its boundary,
///
///     |sigma|_K + (sum_c (h_c/j)² |f - Pi_c f|²_c)^{1/2},   div sigma = Pi_c f - Pi_q f on each child c,
///
/// The children and their quadrature are made once, for the data of all membranes, with the interface where it is at `time`; nothing where
/// the interface cuts no cell. Collective.
class CutOscillation {
 public:
  CutOscillation(const method::Space& space, int q, const scene::FieldPtr& interface, double time);
  /// Lowers the entries of `bound` (owned cells, not yet divided by the root of the tension) where this is less. Collective.
  void sharpen(const scene::Field& force, double time, std::vector<double>& bound) const;

 private:
  core::Comm comm_;
  int q_;
  std::vector<LocalIndex> cells_;      ///< owned cells that are cut
  mesh::Mesh fine_;                    ///< their children, one after the other
  method::CellQuadrature quadrature_;  ///< on these
  Metrics metric_;
};

}  // namespace thixis::bound
