#pragma once
#include <vector>

#include "feasible/feasible_kernel.hpp"
#include "thixis/algebra/fwd.hpp"

namespace thixis::bound {

/// How far the feasible pair is pressed together where lambda^ acts on a gap, vertex by vertex (docs/methods/estimates.md, 4.2b). Of what
/// the bound pays, |||s - u_h|||² + 2 (lambda^, s_1 - s_2), each is the least in its direction:
///
///     closed(a)   = (lambda^, max(psi_a, 0)) / (2 |||psi_a|||²)    gaps up to that are closed at a vertex, where psi_a has no mean,
///     followed(a) = min(1, (lambda^, max(D, 0)) / |||D|||²)       over the cells around a: the part of D that is taken away there,
///
/// with |||v|||² = sum_alpha mu_alpha theta_alpha² |grad v|². Both are 0 where they would change s on the held boundary; closed(a) where
/// functions with a mean leave a gap in some cell around a, for along the edge of the contact zone the membranes do come apart; and
/// followed(a) where in one of these cells the gap is above |D| anyway.
class Pressing {
 public:
  /// `keeps`: by local vertex, not to follow D. Collective; the space must outlive it.
  Pressing(const method::Space& space, const FeasibleParts& kernel, const std::vector<bool>& dirichlet, const std::vector<bool>& keeps);
  ~Pressing();
  /// kernel: with s_c and lambda, the densities on the owned cells. Overwrites closed and followed. Collective.
  void operator()(const FeasibleParts& kernel);

  /// By local vertex, those of owned cells being valid; of length 0: nothing is closed, or followed, on any rank.
  const View<double*>& closed() const { return closed_; }
  const View<double*>& followed() const { return followed_; }
  std::size_t bytes() const;

 private:
  void integrate_functions(const reference::CellBasis& basis, const FeasibleParts& kernel, const std::vector<bool>& dirichlet);
  void integrate_deviation(const FeasibleParts& kernel, const std::vector<bool>& keeps);
  /// The sums over all ranks of what cells have added at their local vertices.
  void add_up(algebra::MultiVector& columns) const;

  const mesh::Mesh& mesh_;
  Teuchos::RCP<const algebra::Import> import_;  ///< vertices of this rank's own -> all local ones
  double positive_[3] = {};                     ///< ∫ max(psi_a, 0) over the reference triangle, times 2
  View<double*> stiffness_;                     ///< by vertex: |||psi_a|||², 0 where the vertex is held
  View<const LocalIndex*> place_;               ///< of D
  View<double*> mean_of_positive_, cost_;       ///< by place: the mean of max(D, 0); by vertex: |||D|||², 0: not to be followed
  View<double*> closed_, followed_;
};

}  // namespace thixis::bound
