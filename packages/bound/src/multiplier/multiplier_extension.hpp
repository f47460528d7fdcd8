#pragma once
#include <vector>

#include "multiplier/multiplier_fits.hpp"
#include "thixis/algebra/fwd.hpp"

namespace thixis::bound {

/// Gives the patches whose moments do not determine a polynomial (corners of the held boundary, patches without a free function) the mean
/// of the polynomials of the vertices around, continued; from vertex to vertex where those around have none either:
///
///     L_a = mean of L_b over the vertices b of the cells around a that have one, each counted once per cell.
class MultiplierExtension {
 public:
  /// `fits`: of the same patches; a patch whose polynomials are constants has one where it has a free function. Collective.
  MultiplierExtension(const method::Space& space, const VertexPatches& patches, const Fits& fits);
  /// `coefficients`: scaled monomials of every patch (a, b), `mean`: a mean of lambda in it, at least 0; -1 where nothing is known of it.
  /// Overwrites the coefficients of the patches without a fit, and their mean where it is -1; what no vertex reaches becomes 0. Collective.
  void operator()(const CellTable& coefficients, const View<double*>& mean) const;
  /// Of each patch: 0 where it has a polynomial of its own, else the round in which it gets one; -1: never.
  View<int*> generations() const;

 private:
  using Around = std::vector<LocalIndex>;  ///< local vertices, with repetition
  void find_generations(const Fits& fits);
  /// The vertices around patch a that have a polynomial before `round`.
  Around sources(LocalIndex a, int round) const;

  int degree_, columns_;
  core::Comm comm_;
  std::vector<LocalIndex> patch_vertex_, patch_of_vertex_;
  std::vector<Around> around_;         ///< of each patch without a fit; empty for others
  std::vector<int> generation_;        ///< of each local vertex of patch cells: the round in which it is reached, -1: never
  int rounds_ = 0;                     ///< on any rank
  std::vector<LocalIndex> own_, all_;  ///< local vertices in the order of the maps of the import
  std::vector<double> diameter_;       ///< of each local vertex of patch cells
  View<double* [2]>::HostMirror place_;
  Teuchos::RCP<const algebra::Import> import_;
};

}  // namespace thixis::bound
