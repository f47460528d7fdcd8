#pragma once
#include <Kokkos_Core.hpp>
#include <vector>

#include "thixis/contact/small.hpp"
#include "thixis/core/types.hpp"

namespace thixis::contact {

/// Coordinates y of the fields at a node, u = T y, in which gaps are unknowns: Bᵀ T = (0 | 1), so that the last coordinates are the gaps
/// Bᵀ u and the others, the means, move along them. The columns of T that belong to gaps are orthogonal to the means in the weights W,
///
///     T_z = W^{-1} B (Bᵀ W^{-1} B)^{-1}:
///
/// where S = W ⊗ S_0, Tᵀ S T has no block between means and gaps. Two membranes of tensions mu: y = (w, z), z = u_1 - u_2,
/// w = theta_1 u_1 + theta_2 u_2, theta = mu / (mu_1 + mu_2).
struct Frame {
  Small T, inverse;
};

/// B(i, g): field i in gap g. weight: W_i > 0. Throws core::InternalError where the columns of B depend on each other.
Frame make_frame(int fields, int gaps, const Small& B, const std::vector<double>& weight);

/// The frame of each node, ghosts included. One for all of them if `kind` is empty.
struct Frames {
  Kokkos::View<const Small*> T, inverse;
  Kokkos::View<const int*> kind;

  Frames() = default;
  explicit Frames(const std::vector<Frame>& frames, const Kokkos::View<const int*>& kind = {});
  bool uniform() const { return kind.extent(0) == 0; }
  KOKKOS_INLINE_FUNCTION int at(LocalIndex node) const { return kind.extent(0) == 0 ? 0 : kind(node); }
};

}  // namespace thixis::contact
