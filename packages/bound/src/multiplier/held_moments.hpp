#pragma once
#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// In cells of which some functions are held (dG with strong data) nothing is known of the moments of lambda against these. They are taken
/// from the polynomial that fits the moments against the free functions of the cell best, of degree p - 1 or of the highest that these
/// determine, drawn to its mean just so far that it is nowhere negative (docs/methods/estimates.md, 5).
class HeldMoments {
 public:
  explicit HeldMoments(const method::Space& space);
  /// `moments`: of lambda by entry, 0 at held ones. Not collective.
  void operator()(const View<const double*>& moments) const;
  /// (patch cell, l): against held functions, 0 at free ones; of length 0 where nothing is held.
  const CellTable& of_cells() const { return of_cells_; }

 private:
  Kokkos::View<const LocalIndex**, Kokkos::LayoutRight> entries_;
  View<LocalIndex*> cells_;                            ///< with held functions, among the patch cells
  View<int*> pattern_;                                 ///< of each of them
  Kokkos::View<double***, Kokkos::LayoutRight> fit_;   ///< (pattern, b, l): moments -> Bernstein coefficients of degree p - 1
  Kokkos::View<double***, Kokkos::LayoutRight> held_;  ///< (pattern, l, b): these -> moments against the held functions
  CellTable of_cells_;
};

}  // namespace thixis::bound
